#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cloud2csg/export.hpp"
#include "io/openscad/path_functions.hpp"
#include "io/scripts/openscad_blocks.hpp"
#include "io/scripts/openscad_loops.hpp"
#include "io/scripts/openscad_solids.hpp"
#include "io/scripts/script_plan.hpp"

namespace cloud2csg {
namespace {

using Kind = script::Step::Kind;

/// The parts of the program, in their order.
struct Program {
  std::string parameters;  ///< before the first brace, where OpenSCAD's customiser looks for them
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

/// A pattern member as the comment on its loop names it.
std::string member_name(const script::Plan& plan, std::size_t member, const std::vector<std::string>& names) {
  std::vector<std::string> solids;
  for (const PrimitiveIndex index : openscad::primitives_of_step(plan, member)) solids.push_back(names[index]);
  return solids.size() == 1 ? solids.front() : fmt::format("({})", fmt::join(solids, ", "));
}

class ProgramWriter {
 public:
  ProgramWriter(const script::Plan& plan, const PrimitiveSet& primitives, const OpenScadOptions& options)
      : plan_(plan),
        primitives_(primitives),
        context_{.everything = plan.everything,
                 .mesh_resolution = options.mesh_resolution,
                 .number = script::NumberFormat(plan.everything.sizes().maxCoeff()),
                 .facets = options.facets},
        names_(script::names_of(primitives, modules_)) {
    if (options.patterns) loops_ = openscad::loops_of(plan, primitives);
  }

  Program write() {
    std::map<PrimitiveIndex, std::size_t> loop_of;  // loops over single primitives
    for (const auto& [step, loop] : loops_.first) {
      if (plan_.steps[step].kind == Kind::primitive) loop_of.emplace(plan_.steps[step].primitive, step);
    }
    for (const PrimitiveIndex index : primitives_of(plan_)) {
      if (loops_.unwritten.contains(index)) continue;
      openscad::Parameters parameters(names_[index], variables_);
      write_module(index, parameters);
      if (const auto loop = loop_of.find(index); loop != loop_of.end()) add_head(loop->second, parameters);
      program_.parameters += parameters.section();
    }
    for (const auto& [step, loop] : loops_.first) {
      if (plan_.steps[step].kind == Kind::primitive) continue;
      // The loop's own section, because the values of its solids have theirs.
      const std::string name = modules_.take(names_[openscad::primitives_of_step(plan_, step).front()] + "_part");
      openscad::Parameters parameters(name, variables_);
      add_head(step, parameters);
      program_.parameters += parameters.section();
    }
    write_tree();
    return std::move(program_);
  }

 private:
  void write_module(PrimitiveIndex index, openscad::Parameters& parameters) {
    const Primitive& primitive = primitives_[index];
    const std::string note = names_[index] == primitive.id ? "" : script::comment(primitive.id, "// ");
    (openscad::needs_mesh(primitive) ? program_.meshes : program_.modules) += fmt::format(
        "\n{}module {}() {{\n  {}\n}}\n", note, names_[index], openscad::solid(primitive, context_, parameters));
  }

  void add_head(std::size_t step, openscad::Parameters& parameters) {
    const openscad::Loop& loop = loops_.first.at(step);
    std::vector<std::string> members;
    for (const std::size_t member : loop.pattern.members) members.push_back(member_name(plan_, member, names_));
    heads_.emplace(step, openscad::loop_over(loop, members, context_.number, parameters));
  }

  void write_tree() {
    bool has_everything = false;
    const auto statement_of = [&](std::size_t step) -> std::string {
      if (plan_.steps[step].kind == Kind::primitive) return names_[plan_.steps[step].primitive] + "();";
      has_everything = true;
      return "everything();";
    };
    const auto before = [&](std::size_t step) -> std::optional<std::string> {
      if (loops_.replaced.contains(step)) return {};
      const auto head = heads_.find(step);
      return head == heads_.end() ? "" : head->second;
    };
    program_.tree = openscad::print_blocks(plan_, {.statement_of = statement_of, .before = before},
                                           openscad::Intersections::of_all);
    if (has_everything) program_.modules += everything_module(context_);
  }

  const script::Plan& plan_;
  const PrimitiveSet& primitives_;
  openscad::SolidContext context_;
  script::UniqueNames modules_{openscad::reserved_words()};
  script::UniqueNames variables_{openscad::reserved_words()};
  std::vector<std::string> names_;
  openscad::Loops loops_ = {};
  std::map<std::size_t, std::string> heads_ = {};  ///< heads of loops, by the step that they repeat
  Program program_ = {};
};

}  // namespace

std::string to_openscad(const Model& model, const OpenScadOptions& options) {
  validate(options);
  const script::Plan plan = script::plan_script(model);
  const Program program = ProgramWriter(plan, model.primitives, options).write();
  std::string text = script::comment(options.comment, "// ");
  text += fmt::format("$fn = {};  // facets of a full circle\n", options.facets);
  if (!program.parameters.empty()) text += "\n// Lengths are in the model's units, angles in degrees.\n";
  const bool has_arcs = program.modules.find("polygon(path(") != std::string::npos;
  text += program.parameters + "\n" + program.tree + program.modules;
  if (has_arcs) text += scad::k_path_functions;
  return text + program.meshes;
}

}  // namespace cloud2csg
