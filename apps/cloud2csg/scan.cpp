#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cloud2csg/compare.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/sample.hpp"
#include "command.hpp"
#include "core/base/output_set.hpp"
#include "io/formats/formats.hpp"
#include "outputs.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

struct ScanCommand {
  std::string shape;
  std::vector<std::string> outputs;
  ScanOptions scanning;
  bool is_perfect = false;
  bool is_ascii = false;
  RunOptions running;

  void run(std::stop_token stop) const;
};

PointCloud scan_shape(const Shape3d& shape, const std::string& file, const ScanOptions& options,
                      const RunContext& run) {
  if (shape.model) return scan_model(tree_of(*shape.model, file), shape.model->primitives, options, run);
  if (shape.mesh) return scan_mesh(*shape.mesh, options, run);
  throw Error({.file = file,
               .where = {},
               .expected = "expected a model with a tree or a mesh, found a point cloud",
               .remedy = "scan what the cloud was made of"});
}

void ScanCommand::run(std::stop_token stop) const {
  for (const std::string& file : outputs) check_output(file, cloud_endings());
  std::vector<std::string> files = outputs;
  files.push_back(shape);  // a mesh and a cloud may both be .ply
  check_distinct(files);
  Session session(running, std::move(stop));
  const Shape3d read = read_shape(shape);
  if (read.model) session.warn(read.model->warnings);
  const ScanOptions options = is_perfect ? without_defects(scanning) : scanning;
  const PointCloud cloud = naming(shape, [&] { return scan_shape(read, shape, options, session.run()); });
  OutputSet written;
  for (const std::string& file : outputs) {
    written.add(file,
                [&](const std::filesystem::path& path) { write_point_cloud(path, cloud, {.binary = !is_ascii}); });
  }
  written.commit();
  session.display().note(fmt::format("{} points from {} views", cloud.size(), options.views));
}

void add_scanner_options(CLI::App& app, ScanOptions& scanning) {
  const auto add = [&app](const char* name, auto& value, const char* type, const char* help) {
    return app.add_option(name, value, help)->type_name(type)->group("Scanner")->capture_default_str();
  };
  CLI::Option* const count =
      add("-n,--count", scanning.count, "COUNT", "How many points in all")->transform(whole_number_from(1));
  app.add_option("--angular-step", scanning.angular_step_deg, "Degrees between neighbouring rays, instead of --count")
      ->check(number_from_to(0, 170))
      ->type_name("DEG")
      ->excludes(count)
      ->group("Scanner");
  add("--views", scanning.views, "N", "Sensors, spread evenly around the part")->transform(whole_number(1, 1'000'000));
  add("--distance", scanning.distance, "R", "From the middle of the part, in radii of its bounding sphere")
      ->check(number_from_to(1.001, 1e6));
  app.add_flag("--on-table", scanning.on_table, "Sensors above the part only: its underside, along z, is not seen")
      ->group("Scanner");
  app.add_option("--field-of-view", scanning.field_of_view_deg,
                 "Width and height of a view in degrees; if not given, just the bounding sphere")
      ->check(number_from_to(0, 170))
      ->type_name("DEG")
      ->group("Scanner");
  add("--seed", scanning.seed, "S", "Same seed, same points")->transform(whole_number_from(0));
  add("--resolution", scanning.meshing.resolution, "N",
      "Models: cells along the longest side of the mesh that tells what a ray hits first")
      ->transform(whole_number(4, 4096));
}

void add_defects(CLI::App& app, ScanCommand& command) {
  CLI::Option* const perfect = app.add_flag("--perfect", command.is_perfect, "None of the defects")->group("Defects");
  const auto add = [&](const char* name, double& value, const char* type, const char* help) {
    return app.add_option(name, value, help)
        ->type_name(type)
        ->group("Defects")
        ->excludes(perfect)
        ->capture_default_str();
  };
  ScanOptions& scanning = command.scanning;
  add("--noise", scanning.noise, "SHARE",
      "Sigma of the range, of the bounds' diagonal; grows with the range squared and grazing incidence")
      ->check(number_not_negative());
  add("--quantisation", scanning.quantisation, "SHARE", "Step of the range, of the diagonal")
      ->check(number_not_negative());
  add("--grazing-angle", scanning.grazing_angle_deg, "DEG", "Incidence from which on returns are missing")
      ->check(number_from_to(0, 89.999));
  add("--grazing-loss", scanning.grazing_loss, "P", "Probability that they are, at 90 degrees")->check(share());
  add("--outliers", scanning.outliers, "P", "Probability that a point is anywhere on its ray")->check(share());
  add("--mixed-pixels", scanning.mixed_pixels, "P", "Probability that a ray at an edge returns from in between")
      ->check(share());
  add("--rotation", scanning.rotation_deg, "DEG", "Sigma of the turn by which each view is out of place")
      ->check(number_not_negative());
  add("--translation", scanning.translation, "SHARE", "... and of each coordinate of its shift, of the diagonal")
      ->check(number_not_negative());
}

void add_options(CLI::App& app, ScanCommand& command) {
  add_file(app, "shape", command.shape,
           fmt::format("Model file with a tree: {}, or mesh: {}", endings_read({FileKind::model}),
                       endings_read({FileKind::mesh})))
      ->type_name("MODEL|MESH");
  add_outputs(app, command.outputs, cloud_endings() + ", with sensor positions in .ply and .pcd");
  app.add_flag("--normals", command.scanning.with_normals, "With the true outward normals, which no scanner knows")
      ->group("Output");
  app.add_flag("--ascii", command.is_ascii, "Text instead of binary numbers in .ply and .pcd")->group("Output");
  add_scanner_options(app, command.scanning);
  add_defects(app, command);
  add_run_options(app, command.running);
}

}  // namespace

Command add_scan(CLI::App& program) {
  CLI::App* app =
      program.add_subcommand("scan", "Makes the cloud that a range scanner would: occlusion, noise, outliers");
  app->footer(
      example("  cloud2csg scan bracket.json -n 50000 --views 12 -o bracket.ply\n"
              "  cloud2csg scan part.stl --noise 0.002 --rotation 0.1 -o part.ply"));
  auto command = std::make_shared<ScanCommand>();
  add_options(*app, *command);
  return {.options = app, .run = [command](std::stop_token stop) { command->run(std::move(stop)); }};
}

}  // namespace cloud2csg::app
