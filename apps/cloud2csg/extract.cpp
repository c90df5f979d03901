#include "cloud2csg/extract.hpp"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <optional>

#include "base/atomic_file.hpp"
#include "base/output_set.hpp"
#include "base/stopwatch.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "command.hpp"
#include "extract_arguments.hpp"
#include "outputs.hpp"
#include "summary.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

constexpr std::array<std::string_view, 1> k_statistics_endings{".json"};

struct ExtractCommand {
  std::string cloud;
  std::string primitives;
  std::vector<std::string> outputs;
  std::optional<std::string> statistics;
  std::optional<std::string> unexplained;
  ExtractArguments arguments;
  RunOptions running;

  void run(const std::stop_token& stop) const;
  /// What is going to be written, after a look at whether it can be.
  [[nodiscard]] std::vector<std::string> check_files() const;
  [[nodiscard]] PointCloud unexplained_part(const PointCloud& points, const PrimitiveSet& solids,
                                            const Extraction& result, int threads) const;
  /// Returns warnings.
  [[nodiscard]] std::vector<std::string> write(const Extraction& result, const PrimitiveSet& solids,
                                               const RunContext& run, OutputSet& written) const;
};

PointCloud read_cloud_with_normals(const std::string& file, const RunContext& run) {
  PointCloud cloud = read_point_cloud(file, run);
  if (!cloud.has_normals()) {
    throw Error(
        {.file = file,
         .where = {},
         .expected = "the points have no normals, which extract needs",
         .remedy = "estimate outward normals, e.g. with MeshLab or CloudCompare, and save them with the points"});
  }
  return cloud;
}

/// The points that the tree contradicts.
PointCloud ExtractCommand::unexplained_part(const PointCloud& points, const PrimitiveSet& solids,
                                            const Extraction& result, int threads) const {
  const SegmentationTolerances tolerances =
      segmentation_tolerances(arguments.options().segmentation, result.statistics.noise);
  PointCloud part;
  for (const std::uint32_t i : unexplained_points(result.tree, solids, points, tolerances, {.threads = threads})) {
    part.positions.push_back(points.positions[i]);
    part.normals.push_back(points.normals[i]);
  }
  return part;
}

std::string headline(const ExtractStatistics& statistics, const std::string& cloud) {
  return fmt::format(
      "{}extracted by cloud2csg {} from {} (seed {})\n{} nodes, {} leaves, depth {}; rms distance {:.4g}, rms angle "
      "{:.3g} deg",
      statistics.complete ? "" : "INCOMPLETE: the search was stopped before its end\n", CLOUD2CSG_VERSION, cloud,
      statistics.seed, statistics.tree.size, statistics.tree.leaves, statistics.tree.depth, statistics.fit.rms_distance,
      statistics.fit.rms_angle_deg);
}

std::vector<std::string> ExtractCommand::write(const Extraction& result, const PrimitiveSet& solids,
                                               const RunContext& run, OutputSet& written) const {
  const std::string comment = headline(result.statistics, cloud);
  const Model model{.primitives = solids, .tree = result.tree, .description = comment};
  // Not to be stopped: what has been found is written also after an interrupt.
  const RunContext writing{.stop = {}, .on_progress = run.on_progress, .threads = run.threads};
  return naming(primitives,
                [&] { return add_models(written, outputs, model, {.openscad = {.comment = comment}}, writing); });
}

std::vector<std::string> ExtractCommand::check_files() const {
  for (const std::string& file : outputs) check_output(file, model_endings());
  if (statistics) check_output(*statistics, k_statistics_endings);
  if (unexplained) check_output(*unexplained, cloud_endings());
  std::vector<std::string> written = outputs;
  if (unexplained) written.push_back(*unexplained);
  if (statistics) written.push_back(*statistics);
  std::vector<std::string> all = written;
  all.insert(all.end(), {cloud, primitives});
  check_distinct(all);
  return written;
}

void ExtractCommand::run(const std::stop_token& stop) const {
  const Stopwatch total;
  const std::vector<std::string> to_write = check_files();
  Session session(running, stop);

  const PrimitiveSet solids = read_model(primitives).primitives;
  const PointCloud points = read_cloud_with_normals(cloud, session.run());
  const double read_seconds = total.seconds();
  Extraction result = naming(cloud + " with " + primitives,
                             [&] { return extract_csg(points, solids, arguments.options(), session.run()); });

  const Stopwatch writing;
  OutputSet written;
  std::vector<std::string> warnings = write(result, solids, session.run(), written);
  if (unexplained) {
    written.add(*unexplained, [&](const std::filesystem::path& path) {
      write_point_cloud(path, unexplained_part(points, solids, result, session.run().threads));
    });
  }
  StageSeconds& seconds = result.statistics.seconds;
  seconds.read = read_seconds;
  seconds.write = writing.seconds();
  seconds.total = total.seconds();
  result.statistics.warnings.insert(result.statistics.warnings.end(), warnings.begin(), warnings.end());
  if (statistics) {
    written.add(*statistics,
                [&](const std::filesystem::path& path) { write_text_file(path, to_json(result.statistics)); });
  }
  written.commit();

  for (const std::string& warning : result.statistics.warnings) session.display().note("warning: " + warning);
  for (const std::string& line : summary_of(result.statistics, to_write)) session.display().note(line);
  if (stop.stop_requested() && !result.statistics.complete) {
    throw Error({.file = {}, .where = "interrupted", .expected = "the best tree so far was written", .remedy = {}});
  }
}

void add_options(CLI::App& app, ExtractCommand& command) {
  add_file(app, "cloud", command.cloud, "Point cloud with normals: .ply .pcd .xyz .xyzn .txt .pts")->type_name("CLOUD");
  add_file(app, "--primitives", command.primitives, "Model file with the primitives to combine")
      ->type_name("MODEL.json")
      ->group("Input");
  add_outputs(app, command.outputs, join_endings(model_endings()));
  app.add_option("--stats", command.statistics, "Statistics: times, search, merge, fit")
      ->check(file_name())
      ->type_name("STATS.json")
      ->group("Output");
  app.add_option("--unexplained", command.unexplained,
                 "The points that the tree contradicts: off its surface, or with another normal")
      ->check(file_name())
      ->type_name("CLOUD")
      ->group("Output");
  add_extract_arguments(app, command.arguments);
  add_run_options(app, command.running);
}

}  // namespace

Command add_extract(CLI::App& program) {
  CLI::App* app = program.add_subcommand("extract", "Turns a point cloud and its primitives into a CSG tree");
  app->footer(
      "A .json output keeps all primitives as they were given; the tree leaves out those that no point supports.\n\n" +
      example("  cloud2csg extract bracket.ply --primitives fitted.json -o bracket.scad -o bracket.json"));
  auto command = std::make_shared<ExtractCommand>();
  add_options(*app, *command);
  app->final_callback([app, command] { check_arguments(*app, command->arguments); });
  return {.options = app, .run = [command](const std::stop_token& stop) { command->run(stop); }};
}

}  // namespace cloud2csg::app
