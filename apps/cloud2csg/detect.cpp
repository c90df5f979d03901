#include "cloud2csg/advanced/detect.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <numbers>
#include <optional>

#include "cloud2csg/input.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "core/base/files.hpp"
#include "core/geometry/place_text.hpp"
#include "field_arguments.hpp"
#include "io/formats/formats.hpp"
#include "outputs.hpp"
#include "raw_options.hpp"
#include "verdict.hpp"

namespace cloud2csg::app {
namespace {

constexpr const char* k_endings = ".json .ply .png";

struct DetectCommand {
  std::string cloud;
  std::string primitives;  // known primitives; empty: none
  bool detect_rest = false;
  bool json = false;
  std::vector<std::string> outputs;
  ReconstructOptions options;
  InputOptions reading;
  PictureOptions drawing;
  RunOptions running;

  [[nodiscard]] int run(std::stop_token stop) const;
  void fail(std::string_view message) const {
    if (json) tell_failure(message);
  }
  void settle(const CLI::App& /*app*/) { share_values(options, reading); }
};

std::string direction_text(const Eigen::Vector3d& v) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", v.x(), v.y(), v.z());
}

std::string sizes_text(const Surface& s) {
  switch (s.type) {
    case SurfaceType::plane:
      return fmt::format("normal {}", direction_text(s.axis));
    case SurfaceType::sphere:
      return fmt::format("radius {:.5g}", s.radius);
    case SurfaceType::cylinder:
      return fmt::format("axis {} radius {:.5g}", direction_text(s.axis), s.radius);
    case SurfaceType::cone:
      return fmt::format("axis {} half angle {:.4g} deg", direction_text(s.axis),
                         s.half_angle * 180 / std::numbers::pi);
    case SurfaceType::torus:
      return fmt::format("axis {} radii {:.5g} {:.5g}", direction_text(s.axis), s.radius, s.minor_radius);
  }
  return {};
}

/// One line per surface with its type, number of points and fit. The diagonal is that of the cloud.
std::string surface_table(const std::vector<DetectedSurface>& surfaces, double diagonal) {
  std::string table;
  for (const DetectedSurface& found : surfaces) {
    table += fmt::format("{:<9} {:>8} points  rms {:<10.3g} at {} {}{}\n", type_name(found.surface.type),
                         found.points.size(), found.rms, place_text(found.surface.position, diagonal),
                         sizes_text(found.surface), found.surface.concave ? " concave" : "");
  }
  return table;
}

/// By point: the colour of its primitive.
std::vector<Colour> colours_of(const Extraction& found) {
  std::vector<Colour> colours(found.cloud.size(), k_no_primitive_colour);
  for (std::size_t k = 0; k < found.points.size(); ++k) {
    for (const std::uint32_t i : found.points[k].points) colours[i] = primitive_colour(k);
  }
  return colours;
}

int DetectCommand::run(std::stop_token stop) const {
  check_outputs(outputs, k_endings, inputs_of(cloud, primitives));
  Session session(running, std::move(stop));

  Model known;
  if (!primitives.empty()) known = read_model(primitives);
  const Input input = read_cloud_or_mesh(cloud, reading, session.run());
  ReconstructOptions from_raw = options_for(input, options);
  from_raw.known = known.primitives;
  session.warn(known.warnings);
  session.warn(input.warnings);
  const Extraction found = naming(primitives.empty() ? cloud : cloud + " with " + primitives,
                                  [&] { return find_primitives(input.cloud, from_raw, session.run()); });

  const FindingStatistics& finding = *found.statistics.finding;
  const std::string table = surface_table(found.surfaces, finding.diagonal);
  const Model model{.primitives = found.model.primitives,
                    .tree = {},
                    .description = fmt::format("found by cloud2csg {} in {}, whose points lie on these surfaces:\n{}",
                                               CLOUD2CSG_VERSION, cloud, table)};
  OutputSet written;
  add_pictures(written, outputs, {.cloud = found.cloud, .colours = colours_of(found)}, drawing, session.run());
  for (const std::string& file : outputs) {
    if (is_picture(file)) continue;
    written.add(file, [&](const std::filesystem::path& path) {
      if (has_ending_of(file, FileKind::model)) {
        write_model(path, model);
      } else {
        write_point_cloud(path, found.cloud, {.colours = colours_of(found)});
      }
    });
  }
  written.commit();
  fmt::print("{}", table);
  session.warn(found.statistics.warnings);
  const LargestChange largest = largest_change(finding.snaps);
  session.display().note(
      fmt::format("{} surfaces; {} of {} points on no surface; {} values made regular, by at most {:.2g} and {:.2g} "
                  "deg; {} solids; noise {:.3g}, tolerance {:.3g}",
                  found.surfaces.size(), finding.unexplained_points, found.cloud.size(), finding.snaps.size(),
                  largest.shift, largest.turn_deg, found.model.primitives.size(), finding.noise, finding.tolerance));
  return tell_verdict(session, found.statistics, outputs, json);
}

void add_options(CLI::App& app, DetectCommand& command, FieldArguments& fields) {
  add_cloud(app, command.cloud);
  CLI::Option* primitives = add_primitives(
      app, command.primitives,
      " with known primitives: they are kept unchanged, and others are found only in points that they do not explain");
  app.add_flag(
         "--detect-rest", command.detect_rest,
         "Accepted as in extract, without effect: --primitives always keeps the given primitives and finds the others")
      ->needs(primitives)
      ->group("Input");
  add_outputs(app, command.outputs, "the solids (.json), or the points in the colours of their solids (.ply, .png)");
  add_json_option(app, command.json);
  fields.add(command.options.extraction,
             {.group = "Finding primitives", .path = "extraction.", .only = {"seed", "time_limit_seconds"}});
  add_raw_options(fields, command.options, command.reading);
  fields.add(command.drawing, {.group = "Pictures"});
}

}  // namespace

Command add_detect(CLI::App& program) {
  CLI::App* app = program.add_subcommand("detect", "Finds primitives in a point cloud, a scan or a mesh");
  app->footer(
      "Prints the surfaces on which the points lie. A .json output has the solids that these surfaces bound, without a "
      "tree, and in its description the surfaces with their numbers of points. Points on no solid are grey in a "
      ".ply.\n\n" +
      example("  cloud2csg detect scan.ply -o primitives.json -o points.ply"));
  return make_command<DetectCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
