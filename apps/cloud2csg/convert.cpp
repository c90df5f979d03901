#include <fmt/format.h>

#include <algorithm>

#include "cloud2csg/export.hpp"
#include "cloud2csg/model.hpp"
#include "core/base/files.hpp"
#include "field_arguments.hpp"
#include "io/formats/formats.hpp"
#include "outputs.hpp"

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
  check_outputs(outputs, model_endings());
  Session session(running, std::move(stop));
  const Model read = read_model(model);
  if (std::any_of(outputs.begin(), outputs.end(), needs_tree)) (void)tree_of(read, model);
  OutputSet written;
  AddedModels added = naming(model, [&] { return add_models(written, outputs, read, exporting, session.run()); });
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

void add_options(CLI::App& app, ConvertCommand& command, FieldArguments& fields) {
  add_file(app, "model", command.model, "Model file: " + endings_read({FileKind::model}))->type_name("MODEL");
  add_outputs(app, command.outputs, model_endings());
  fields.add(command.exporting, {.group = "Output"});
  fields.add(command.drawing, {.group = "Pictures"});
}

}  // namespace

Command add_convert(CLI::App& program) {
  CLI::App* app = program.add_subcommand("convert", "Writes a model in other formats");
  app->footer(example("  cloud2csg convert bracket.json -o bracket.scad -o bracket.step -o bracket.stl"));
  return make_command<ConvertCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
