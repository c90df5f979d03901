#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>
#include <utility>

#include "cloud2csg/export.hpp"
#include "export/openscad_blocks.hpp"
#include "export/openscad_loops.hpp"
#include "export/openscad_solids.hpp"
#include "export/openscad_text.hpp"
#include "export/script_plan.hpp"

namespace cloud2csg {
namespace {

using Kind = script::Step::Kind;

/// The parts of the program, in their order.
struct Program {
  std::string parameters;  ///< before the first brace: there OpenSCAD's customiser looks for them
  std::string tree;
  std::string modules;
  std::string meshes;  ///< long lists of triangles last: nobody edits them
};

std::string everything_module(const openscad::SolidContext& context) {
  return fmt::format(
      "\n// All of space, as far as this model goes.\nmodule everything() {{\n  translate({}) cube({}, center = "
      "true);\n}}\n",
      openscad::list(context.everything.center(), context.number),
      openscad::list(context.everything.sizes().eval(), context.number));
}

Program program_of(const script::Plan& plan, const PrimitiveSet& primitives, const OpenScadOptions& options) {
  const openscad::SolidContext context{.everything = plan.everything,
                                       .mesh_resolution = options.mesh_resolution,
                                       .number = script::NumberFormat(plan.everything.sizes().maxCoeff())};
  script::UniqueNames modules(openscad::reserved_words());
  script::UniqueNames variables(openscad::reserved_words());
  const std::vector<std::string> names = script::names_of(primitives, modules);
  openscad::Loops loops;
  if (options.patterns) loops = openscad::loops_of(plan, primitives);
  Program program;
  std::map<PrimitiveIndex, std::string> calls;
  for (const PrimitiveIndex index : primitives_of(plan)) {
    if (loops.replaced.contains(index)) continue;
    openscad::Parameters parameters(names[index], variables);
    const bool is_mesh = openscad::needs_mesh(primitives[index]);
    const std::string note = names[index] == primitives[index].id ? "" : script::comment(primitives[index].id, "// ");
    (is_mesh ? program.meshes : program.modules) += fmt::format(
        "\n{}module {}() {{\n  {}\n}}\n", note, names[index], openscad::solid(primitives[index], context, parameters));
    const auto loop = loops.first.find(index);
    const std::string around =
        loop == loops.first.end() ? "" : openscad::loop_over(loop->second, names, context.number, parameters);
    calls[index] = around + names[index] + "();";
    program.parameters += parameters.section();
  }
  bool has_everything = false;
  program.tree = openscad::print_blocks(
      plan,
      [&](std::size_t step) -> std::string {
        if (plan.steps[step].kind == Kind::primitive) return calls[plan.steps[step].primitive];
        has_everything = true;
        return "everything();";
      },
      openscad::Intersections::of_all);
  if (has_everything) program.modules += everything_module(context);
  return program;
}

}  // namespace

std::string to_openscad(const CsgTree& tree, const PrimitiveSet& primitives, const OpenScadOptions& options) {
  openscad::validate(options);
  const Program program = program_of(script::plan_script(tree, primitives), primitives, options);
  std::string text = script::comment(options.comment, "// ");
  text += fmt::format("$fn = {};  // facets of a full circle\n", options.facets);
  if (!program.parameters.empty()) text += "\n// Lengths are in the model's units, angles in degrees.\n";
  return text + program.parameters + "\n" + program.tree + program.modules + program.meshes;
}

}  // namespace cloud2csg
