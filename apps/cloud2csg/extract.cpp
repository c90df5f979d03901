#include "cloud2csg/extract.hpp"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <optional>

#include "base/atomic_file.hpp"
#include "base/stopwatch.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "command.hpp"
#include "extract_arguments.hpp"
#include "outputs.hpp"
#include "summary.hpp"

namespace cloud2csg::app {
namespace {

constexpr std::array<std::string_view, 1> k_statistics_endings{".json"};

struct ExtractCommand {
  std::string cloud;
  std::string primitives;
  std::vector<std::string> outputs;
  std::optional<std::string> statistics;
  ExtractArguments arguments;
  RunOptions running;

  void run(const std::stop_token& stop) const;
  void write(const Extraction& result, const PrimitiveSet& solids, const RunContext& run) const;
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

std::string headline(const ExtractStatistics& statistics, const std::string& cloud) {
  return fmt::format(
      "{}extracted by cloud2csg {} from {} (seed {})\n{} nodes, {} leaves, depth {}; rms distance {:.4g}, rms angle "
      "{:.3g} deg",
      statistics.complete ? "" : "INCOMPLETE: the search was stopped before its end\n", CLOUD2CSG_VERSION, cloud,
      statistics.seed, statistics.tree.size, statistics.tree.leaves, statistics.tree.depth, statistics.fit.rms_distance,
      statistics.fit.rms_angle_deg);
}

void ExtractCommand::write(const Extraction& result, const PrimitiveSet& solids, const RunContext& run) const {
  const std::string comment = headline(result.statistics, cloud);
  const Model model{.primitives = solids, .tree = result.tree, .description = comment};
  // Not to be stopped: what has been found is written also after an interrupt.
  const RunContext writing{.stop = {}, .on_progress = run.on_progress, .threads = run.threads};
  for (const std::string& file : outputs) export_model(file, model, {.openscad = {.comment = comment}}, writing);
}

void ExtractCommand::run(const std::stop_token& stop) const {
  const Stopwatch total;
  const ExtractOptions options = arguments.options();
  for (const std::string& file : outputs) check_output(file, model_endings());
  if (statistics) check_output(*statistics, k_statistics_endings);
  std::vector<std::string> written = outputs;
  if (statistics) written.push_back(*statistics);
  std::vector<std::string> all = written;
  all.insert(all.end(), {cloud, primitives});
  check_distinct(all);
  Session session(running, stop);

  const PrimitiveSet solids = read_model(primitives).primitives;
  const PointCloud points = read_cloud_with_normals(cloud, session.run());
  const double read_seconds = total.seconds();
  Extraction result = extract_csg(points, solids, options, session.run());

  const Stopwatch writing;
  write(result, solids, session.run());
  StageSeconds& seconds = result.statistics.seconds;
  seconds.read = read_seconds;
  seconds.write = writing.seconds();
  seconds.total = total.seconds();
  if (statistics) write_text_file(*statistics, to_json(result.statistics));

  for (const std::string& warning : result.statistics.warnings) session.display().note("warning: " + warning);
  for (const std::string& line : summary_of(result.statistics, written)) session.display().note(line);
  if (stop.stop_requested() && !result.statistics.complete) {
    throw Error({.file = {}, .where = "interrupted", .expected = "the best tree so far was written", .remedy = {}});
  }
}

void add_options(CLI::App& app, ExtractCommand& command) {
  app.add_option("cloud", command.cloud, "Point cloud with normals: .ply .pcd .xyz .xyzn .txt .pts")
      ->required()
      ->type_name("CLOUD");
  app.add_option("--primitives", command.primitives, "Model file with the primitives to combine")
      ->required()
      ->type_name("MODEL.json")
      ->group("Input");
  add_outputs(app, command.outputs, join_endings(model_endings()));
  app.add_option("--stats", command.statistics, "Statistics: times, search, merge, fit")
      ->type_name("STATS.json")
      ->group("Output");
  add_extract_arguments(app, command.arguments);
  add_run_options(app, command.running);
}

}  // namespace

Command add_extract(CLI::App& program) {
  CLI::App* app = program.add_subcommand("extract", "Turns a point cloud and its primitives into a CSG tree");
  app->footer(example("  cloud2csg extract bracket.ply --primitives fitted.json -o bracket.scad -o bracket.json"));
  auto command = std::make_shared<ExtractCommand>();
  add_options(*app, *command);
  return {.options = app, .run = [command](const std::stop_token& stop) { command->run(stop); }};
}

}  // namespace cloud2csg::app
