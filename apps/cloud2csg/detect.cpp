#include "cloud2csg/detect.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string_view>

#include "base/output_set.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "command.hpp"
#include "outputs.hpp"
#include "raw_arguments.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

constexpr std::array<std::string_view, 1> k_endings{".json"};

struct DetectCommand {
  std::string cloud;
  std::vector<std::string> outputs;
  RawArguments raw;
  std::uint64_t seed = 1;
  RunOptions running;

  void run(std::stop_token stop) const;
};

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", v.x(), v.y(), v.z());
}

std::string sizes_text(const Surface& s) {
  switch (s.type) {
    case SurfaceType::plane:
      return fmt::format("normal {}", vector_text(s.axis));
    case SurfaceType::sphere:
      return fmt::format("radius {:.5g}", s.radius);
    case SurfaceType::cylinder:
      return fmt::format("axis {} radius {:.5g}", vector_text(s.axis), s.radius);
    case SurfaceType::cone:
      return fmt::format("axis {} half angle {:.4g} deg", vector_text(s.axis), s.half_angle * 180 / std::numbers::pi);
    case SurfaceType::torus:
      return fmt::format("axis {} radii {:.5g} {:.5g}", vector_text(s.axis), s.radius, s.minor_radius);
  }
  return {};
}

/// A surface a line: what it is, how many points lie on it and how near.
std::string surface_table(const std::vector<DetectedSurface>& surfaces) {
  std::string table;
  for (const DetectedSurface& found : surfaces) {
    table += fmt::format("{:<9} {:>8} points  rms {:<10.3g} at {} {}{}\n", type_name(found.surface.type),
                         found.points.size(), found.rms, vector_text(found.surface.position), sizes_text(found.surface),
                         found.surface.concave ? " concave" : "");
  }
  return table;
}

void DetectCommand::run(std::stop_token stop) const {
  for (const std::string& file : outputs) check_output(file, k_endings);
  std::vector<std::string> files = outputs;
  files.push_back(cloud);
  check_distinct(files);
  Session session(running, std::move(stop));

  const ExtractOptions options{.seed = seed};
  const Input input = read_cloud_or_mesh(cloud, raw.input(options), session.run());
  const ReconstructOptions from_raw = raw.options(options, input);
  const FoundPrimitives found = naming(cloud, [&] { return find_primitives(input.cloud, from_raw, session.run()); });

  const std::string table = surface_table(found.detection.surfaces);
  const Model model{.primitives = found.choice.solids,
                    .tree = {},
                    .description = fmt::format("found by cloud2csg {} in {}, whose points lie on:\n{}",
                                               CLOUD2CSG_VERSION, cloud, table)};
  OutputSet written;
  for (const std::string& file : outputs) {
    written.add(file, [&](const std::filesystem::path& path) { write_model(path, model); });
  }
  written.commit();
  fmt::print("{}", table);
  for (const std::string& warning : input.warnings) session.display().note("warning: " + warning);
  for (const std::string& warning : found.warnings) session.display().note("warning: " + warning);
  session.display().note(fmt::format("{} surfaces, {} of {} points on none; {} solids; noise {:.3g}, tolerance {:.3g}",
                                     found.detection.surfaces.size(), found.detection.unexplained,
                                     found.prepared.cloud.size(), found.choice.solids.size(),
                                     found.prepared.scale.noise, found.detection.distance_tolerance));
}

void add_options(CLI::App& app, DetectCommand& command) {
  add_file(app, "cloud", command.cloud,
           "Point cloud: .ply .pcd .xyz .xyzn .txt .pts, or mesh: .stl .off .obj .ply .3mf .glb")
      ->type_name("CLOUD|MESH");
  add_outputs(app, command.outputs, join_endings(k_endings));
  app.add_option("--seed", command.seed, "Same seed, same primitives, whatever the threads")
      ->transform(whole_number_from(0))
      ->type_name("S")
      ->group("Finding primitives")
      ->capture_default_str();
  add_raw_arguments(app, command.raw, "Finding primitives");
  add_run_options(app, command.running);
}

}  // namespace

Command add_detect(CLI::App& program) {
  CLI::App* app = program.add_subcommand("detect", "Finds primitives in a point cloud, a scan or a mesh");
  app->footer(
      "Prints the surfaces that the points lie on; the output has the solids that these bound, without a tree.\n\n" +
      example("  cloud2csg detect scan.ply -o primitives.json"));
  auto command = std::make_shared<DetectCommand>();
  add_options(*app, *command);
  return {.options = app, .run = [command](std::stop_token stop) { command->run(std::move(stop)); }};
}

}  // namespace cloud2csg::app
