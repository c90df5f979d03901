#include "cloud2csg/extract.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "base/atomic_file.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "command.hpp"
#include "outputs.hpp"

namespace cloud2csg::app {
namespace {

constexpr std::array k_strategies{Strategy::automatic, Strategy::partition, Strategy::baseline};
constexpr std::array k_parallels{Parallel::none, Parallel::population, Parallel::partitions, Parallel::both};
constexpr std::array<std::string_view, 1> k_statistics_endings{".json"};

/// What was given on the command line; the rest is as the preset has it.
struct ExtractCommand {
  std::string cloud;
  std::string primitives;
  std::vector<std::string> outputs;
  std::optional<std::string> statistics;
  std::string preset = "default";
  std::optional<std::string> strategy;
  std::optional<std::string> parallel;
  std::optional<double> alpha, beta, gamma;
  std::optional<double> distance_tolerance, angle_tolerance_deg, overlap_tolerance;
  std::optional<int> population, idle_generations;
  std::optional<double> time_limit_seconds;
  std::optional<std::uint64_t> seed;
  RunOptions running;

  void run(const std::stop_token& stop) const;
  [[nodiscard]] ExtractOptions extract_options() const;
  void write(const Extraction& result, const PrimitiveSet& primitives, const RunContext& run) const;
};

template <typename Value, typename Given>
void override_with(Value& value, const std::optional<Given>& given) {
  if (given) value = *given;
}

template <typename Choices, typename Choice>
void override_by_name(const Choices& choices, Choice& value, const std::optional<std::string>& given) {
  for (const Choice choice : choices) {
    if (given && to_string(choice) == *given) value = choice;
  }
}

template <typename Choices>
std::vector<std::string> names_of(const Choices& choices) {
  std::vector<std::string> names;
  names.reserve(choices.size());
  for (const auto choice : choices) names.emplace_back(to_string(choice));
  return names;
}

ExtractOptions ExtractCommand::extract_options() const {
  ExtractOptions options = preset == "paper" ? paper_options() : ExtractOptions{};
  override_by_name(k_strategies, options.strategy, strategy);
  override_by_name(k_parallels, options.parallel, parallel);
  override_with(options.objective.alpha, alpha);
  override_with(options.objective.beta, beta);
  override_with(options.objective.gamma, gamma);
  override_with(options.segmentation.distance_tolerance, distance_tolerance);
  override_with(options.segmentation.angle_tolerance_deg, angle_tolerance_deg);
  override_with(options.overlap_tolerance, overlap_tolerance);
  override_with(options.search.population, population);
  override_with(options.search.idle_generations, idle_generations);
  override_with(options.time_limit_seconds, time_limit_seconds);
  override_with(options.seed, seed);
  validate(options);
  return options;
}

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
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
  const ExtractOptions options = extract_options();
  for (const std::string& file : outputs) check_output(file, model_endings());
  if (statistics) check_output(*statistics, k_statistics_endings);
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
  if (statistics) write_text_file(*statistics, to_json(result.statistics) + "\n");

  for (const std::string& warning : result.statistics.warnings) session.display().note("warning: " + warning);
  session.display().note(headline(result.statistics, cloud));
  if (stop.stop_requested() && !result.statistics.complete) {
    throw Error({.file = {}, .where = "interrupted", .expected = "the best tree so far was written", .remedy = {}});
  }
}

template <typename Value>
CLI::Option* add(CLI::App& app, const std::string& group, const std::string& name, Value& value,
                 const std::string& type, const std::string& help) {
  return app.add_option(name, value, help)->type_name(type)->group(group);
}

void add_search_options(CLI::App& app, ExtractCommand& command) {
  const std::string group = "Search";
  add(app, group, "--preset", command.preset, "NAME",
      "default, or paper: the paper's weights and search, nothing added")
      ->check(CLI::IsMember({"default", "paper"}))
      ->capture_default_str();
  add(app, group, "--strategy", command.strategy, "NAME",
      "auto, partition: a tree per partition, merged, or baseline: all primitives at once (default: auto)")
      ->check(CLI::IsMember(names_of(k_strategies)));
  add(app, group, "--parallel", command.parallel, "WHAT", "none, population, partitions or both (default: both)")
      ->check(CLI::IsMember(names_of(k_parallels)));
  add(app, group, "--seed", command.seed, "S", "Same seed, same tree, whatever the threads (default: 1)");
  add(app, group, "--population", command.population, "N", "Trees a generation (default: 150)")
      ->check(CLI::PositiveNumber);
  add(app, group, "--idle-generations", command.idle_generations, "N",
      "Stop after so many generations without a better tree (default: 40, paper: 10)")
      ->check(CLI::PositiveNumber);
  add(app, group, "--time-limit", command.time_limit_seconds, "SECONDS",
      "Then take the best tree so far (default: none)")
      ->check(finite_not_negative());
}

void add_fit_options(CLI::App& app, ExtractCommand& command) {
  const std::string group = "Fit";
  const auto number = [&](const std::string& name, std::optional<double>& value, const std::string& help) {
    add(app, group, name, value, "X", help)->check(finite_not_negative());
  };
  number("--distance-tolerance", command.distance_tolerance,
         "Points nearer than this belong to a primitive (default: 3 x the measured noise)");
  number("--angle-tolerance", command.angle_tolerance_deg,
         "... when their normal is within so many degrees (default: 30)");
  number("--overlap-tolerance", command.overlap_tolerance,
         "Primitives nearer than this overlap (default: the measured noise)");
  number("--alpha", command.alpha, "Cost of a node, in points (default: ln of the points)");
  number("--beta", command.beta, "Weight of distances (default: 1 / noise, paper: 100)");
  number("--gamma", command.gamma, "Weight of angles, per radian (default: 18 / pi)");
}

void add_options(CLI::App& app, ExtractCommand& command) {
  app.add_option("cloud", command.cloud, "Point cloud with normals: .ply .pcd .xyz .xyzn .txt .pts")
      ->required()
      ->type_name("CLOUD");
  add(app, "Input", "--primitives", command.primitives, "MODEL.json", "Model file with the primitives to combine")
      ->required();
  add_outputs(app, command.outputs, join_endings(model_endings()));
  add(app, "Output", "--stats", command.statistics, "STATS.json", "Statistics: times, search, merge, fit");
  add_search_options(app, command);
  add_fit_options(app, command);
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
