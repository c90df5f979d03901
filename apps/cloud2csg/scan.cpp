#include <fmt/format.h>

#include "cloud2csg/compare.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/sample.hpp"
#include "field_arguments.hpp"
#include "outputs.hpp"

namespace cloud2csg::app {
namespace {

struct ScanCommand {
  std::string shape;
  std::vector<std::string> outputs;
  ScanOptions scanning;
  CloudWriteOptions writing;
  bool is_perfect = false;
  RunOptions running;

  void run(std::stop_token stop) const;
};

PointCloud scan_shape(const Shape3d& shape, const std::string& file, const ScanOptions& options,
                      const RunContext& run) {
  if (shape.model) return scan_model(*shape.model, options, run);
  if (shape.mesh) return scan_mesh(*shape.mesh, options, run);
  throw Error({.file = file,
               .expected = "expected a model with a tree or a mesh, found a point cloud",
               .remedy = "give a model or mesh of the part, from which the cloud was made"});
}

void ScanCommand::run(std::stop_token stop) const {
  check_outputs(outputs, cloud_endings(), {&shape, 1});  // a mesh and a cloud may both be .ply
  Session session(running, std::move(stop));
  const Shape3d read = read_shape(shape);
  if (read.model) session.warn(read.model->warnings);
  const ScanOptions options = is_perfect ? without_defects(scanning) : scanning;
  const PointCloud cloud = naming(shape, [&] { return scan_shape(read, shape, options, session.run()); });
  write_clouds(outputs, cloud, writing);
  session.display().note(fmt::format("{} points from {} views", cloud.size(), options.views));
}

void add_options(CLI::App& app, ScanCommand& command, FieldArguments& fields) {
  add_shape(app, command.shape);
  add_outputs(app, command.outputs, cloud_endings() + ", with sensor positions in .ply and .pcd");
  fields.add(command.writing, {.group = "Output"});
  fields.add(command.scanning, {.group = "Scanner"});
  CLI::Option* const perfect =
      app.add_flag("--perfect", command.is_perfect, "Scan without any defects")->group("Defects");
  for (CLI::Option* const option : app.get_options()) {
    if (option != perfect && option->get_group() == perfect->get_group()) option->excludes(perfect);
  }
  app.get_option("--angular-step")->excludes(app.get_option("--count"));
}

}  // namespace

Command add_scan(CLI::App& program) {
  CLI::App* app = program.add_subcommand("scan", "Simulates the cloud of a range scanner: occlusion, noise, outliers");
  app->footer(
      example("  cloud2csg scan bracket.json -n 50000 --views 12 -o bracket.ply\n"
              "  cloud2csg scan part.stl --noise 0.002 --rotation 0.1 -o part.ply"));
  return make_command<ScanCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
