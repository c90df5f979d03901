#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cloud2csg/export.hpp"
#include "cloud2csg/model.hpp"
#include "command.hpp"
#include "core/base/output_set.hpp"
#include "io/formats/formats.hpp"
#include "outputs.hpp"
#include "reports.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

struct ConvertCommand {
  std::string model;
  std::vector<std::string> outputs;
  ExportOptions exporting;
  PictureOptions drawing;
  RunOptions running;

  void run(std::stop_token stop) const;
};

void ConvertCommand::run(std::stop_token stop) const {
  for (const std::string& file : outputs) check_output(file, model_endings());
  check_distinct(outputs);
  check_pictures(drawing);
  Session session(running, std::move(stop));
  const Model read = read_model(model);
  if (std::any_of(outputs.begin(), outputs.end(), needs_tree)) (void)tree_of(read, model);
  OutputSet written;
  ExportOptions options = exporting;
  options.script.facet_resolution = options.brep.facet_resolution;
  AddedModels added = naming(model, [&] { return add_models(written, outputs, read, options, session.run()); });
  std::vector<std::string> warnings = read.warnings;
  warnings.insert(warnings.end(), added.warnings.begin(), added.warnings.end());
  const Report report{.title = std::filesystem::path(model).filename().string(),
                      .source = read.description,
                      .model = read,
                      .downloads = std::move(added.texts),
                      .warnings = warnings};
  naming(model, [&] { add_reports(written, outputs, report, session.run()); });
  naming(model, [&] { add_pictures(written, outputs, {.model = read}, drawing, session.run()); });
  written.commit();
  session.warn(warnings);
}

void add_options(CLI::App& app, ConvertCommand& command) {
  add_file(app, "model", command.model, "Model file: " + endings_read({FileKind::model}))->type_name("MODEL");
  add_outputs(app, command.outputs, model_endings());
  add_mesh_options(app, command.exporting);
  app.add_option("--facets", command.exporting.openscad.facets, "OpenSCAD (.scad .csg): facets of a full circle")
      ->transform(whole_number(3, 10'000))
      ->type_name("N")
      ->group("Output")
      ->capture_default_str();
  app.add_flag("--with-primitives", command.exporting.brep.with_primitives,
               "STEP: the primitives, too, as components with their names")
      ->group("Output");
  app.add_option("--facet-resolution", command.exporting.brep.facet_resolution,
                 "STEP, BREP, .FCMacro, .py: cells along the longest side of what has no exact surface")
      ->transform(whole_number(4, 256))
      ->type_name("N")
      ->group("Output")
      ->capture_default_str();
  add_picture_options(app, command.drawing);
  add_run_options(app, command.running);
}

}  // namespace

Command add_convert(CLI::App& program) {
  CLI::App* app = program.add_subcommand("convert", "Writes a model in other formats");
  app->footer(example("  cloud2csg convert bracket.json -o bracket.scad -o bracket.step -o bracket.stl"));
  auto command = std::make_shared<ConvertCommand>();
  add_options(*app, *command);
  return {.options = app, .run = [command](std::stop_token stop) { command->run(std::move(stop)); }};
}

}  // namespace cloud2csg::app
