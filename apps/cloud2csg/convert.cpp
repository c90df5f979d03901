#include <fmt/format.h>

#include <memory>

#include "cloud2csg/export.hpp"
#include "cloud2csg/model.hpp"
#include "command.hpp"
#include "outputs.hpp"

namespace cloud2csg::app {
namespace {

struct ConvertCommand {
  std::string model;
  std::vector<std::string> outputs;
  ExportOptions exporting;
  RunOptions running;

  void run(std::stop_token stop) const;
};

void ConvertCommand::run(std::stop_token stop) const {
  for (const std::string& file : outputs) check_output(file, model_endings());
  check_distinct(outputs);
  Session session(running, std::move(stop));
  const Model read = read_model(model);
  for (const std::string& file : outputs) export_model(file, read, exporting, session.run());
}

void add_options(CLI::App& app, ConvertCommand& command) {
  app.add_option("model", command.model, "Model file")->required()->type_name("MODEL.json");
  add_outputs(app, command.outputs, join_endings(model_endings()));
  app.add_option("--resolution", command.exporting.meshing.resolution,
                 "Meshes (.stl .off .obj): cells along the longest side")
      ->check(CLI::Range(4, 4096))
      ->type_name("N")
      ->group("Output")
      ->capture_default_str();
  app.add_option("--facets", command.exporting.openscad.facets, "OpenSCAD: facets of a full circle ($fn)")
      ->check(CLI::Range(3, 10'000))
      ->type_name("N")
      ->group("Output")
      ->capture_default_str();
  add_run_options(app, command.running);
}

}  // namespace

Command add_convert(CLI::App& program) {
  CLI::App* app = program.add_subcommand("convert", "Writes a model in other formats");
  app->footer(example("  cloud2csg convert bracket.json -o bracket.scad -o bracket.stl"));
  auto command = std::make_shared<ConvertCommand>();
  add_options(*app, *command);
  return {.options = app, .run = [command](std::stop_token stop) { command->run(std::move(stop)); }};
}

}  // namespace cloud2csg::app
