#include "cloud2csg/extract.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/run.hpp"
#include "core/primitive/profile.hpp"
#include "paper/objective/objective.hpp"
#include "pipeline/diagnostics.hpp"
#include "pipeline/extraction_run.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/verdict.hpp"

namespace cloud2csg {
namespace {

/// Work limit of climbing by E, in evaluations x classes x nodes: about a second.
constexpr double k_climbing_work = 4e9;

void check_primitive(const Primitive& primitive) {
  try {
    validate(primitive);
  } catch (const Error& error) {
    Error::Parts parts = error.parts();
    parts.where = fmt::format("primitive '{}': {}", primitive.id, parts.where);
    throw Error(std::move(parts));
  }
}

bool is_finite(const Points& points) {
  const auto all = [](const std::vector<double>& numbers) {
    return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
  };
  return all(points.x) && all(points.y) && all(points.z);
}

void check_input(const PointCloud& cloud, const PrimitiveSet& primitives) {
  const auto refuse = [](const char* expected, const char* remedy) {
    throw Error({.expected = expected, .remedy = remedy});
  };
  if (cloud.size() == 0) refuse("the cloud has no points", "");
  if (!std::isfinite(bounds_of(cloud.positions).diagonal().norm()) || !is_finite(cloud.positions) ||
      !is_finite(cloud.normals)) {
    refuse("the cloud has coordinates or normals that are not finite, or too large", "remove these points");
  }
  if (!cloud.has_normals() || cloud.normals.size() != cloud.size()) {
    refuse(
        "the cloud has no normals, which tell inside from outside",
        "add them, e.g. in MeshLab (Filters > Point Set > Compute normals), CloudCompare or Open3D, and save as .ply");
  }
  if (primitives.empty()) refuse("there are no primitives", "give a model file with the fitted primitives");
  if (cloud.size() > std::numeric_limits<std::uint32_t>::max()) refuse("more than 4 294 967 295 points", "down-sample");
  for (const Primitive& primitive : primitives) check_primitive(primitive);
}

class Extractor {
 public:
  Extractor(const PointCloud& cloud, const PrimitiveSet& input, const ExtractOptions& options, const RunContext& run,
            const TimeLimit& limit)
      : cloud_(cloud), input_(input), options_(options), run_(run, options.parallel, limit) {
    options_.search.seed = options.seed;
    statistics_.strategy = options.strategy;
    statistics_.parallel = options.parallel;
    statistics_.threads = run.threads;
    statistics_.seed = options.seed;
    statistics_.points = cloud.size();
    statistics_.primitives = input.size();
  }

  Extraction extract() {
    Stopwatch total;
    Stopwatch watch;
    scale_ = measure_noise_scale(cloud_, input_, options_.segmentation, run_.pass());
    statistics_.noise = scale_.noise;
    statistics_.seconds.segment = watch.lap();
    const CsgTree tree = simplified(is_solved_by_cells() ? take_cells() : solve_by_partitions());
    statistics_.seconds.extraction = total.lap();
    finish(tree);
    statistics_.seconds.total = statistics_.seconds.extraction + total.lap();
    return {.model = {.primitives = input_, .tree = tree}, .statistics = std::move(statistics_)};
  }

 private:
  /// Whether the cells' tree is requested or supported by the points. Keeps the tree otherwise, for comparison.
  bool is_solved_by_cells() {
    const bool is_asked_for = options_.strategy == Strategy::cells;
    if (!is_asked_for && (options_.strategy != Strategy::automatic || options_.cell_trust > 1)) return false;
    by_cells_ = extract_by_cells(cloud_, input_, scale_, options_, run_);
    statistics_.seconds += by_cells_->seconds;
    run_.enforce_limit();
    if (is_asked_for && !by_cells_->tree) {
      statistics_.warnings.emplace_back(
          "more than 64 primitives depend on each other in the cells, so partitions were searched instead");
    }
    return by_cells_->tree && (is_asked_for || by_cells_->trust() >= options_.cell_trust);
  }

  CsgTree take_cells() {
    statistics_.cells = by_cells_->statistics;
    note_way(by_cells_->complex.unassigned, by_cells_->supported.warnings);
    statistics_.complete = statistics_.complete && by_cells_->is_complete;
    statistics_.steps = by_cells_->steps;
    return *by_cells_->tree;
  }

  CsgTree take_partitions() {
    note_way(by_partitions_->unassigned, by_partitions_->warnings);
    note("merged partitions", by_partitions_->tree);
    return by_partitions_->tree;
  }

  void note_way(std::size_t unassigned, const std::vector<std::string>& warnings) {
    statistics_.unassigned_points = unassigned;
    append(statistics_.warnings, warnings);
  }

  /// Takes the tree of higher E, of the partitions' and the cells', and improves it by a local search.
  CsgTree solve_by_partitions() {
    by_partitions_ = extract_by_partitions(cloud_, input_, scale_, options_, run_);
    statistics_.seconds += by_partitions_->seconds;
    statistics_.complete = by_partitions_->is_complete;
    statistics_.clique_histogram = by_partitions_->clique_histogram;
    statistics_.components = by_partitions_->components;
    statistics_.partitions = by_partitions_->partitions;
    statistics_.merge = by_partitions_->merge;
    if (!by_cells_ || !by_cells_->tree) return take_partitions();
    CsgTree start = better_start();
    if (!options_.polish) return start;
    CsgTree climbed = climb(start);
    if (climbed == start || objective_of(climbed) <= objective_of(start)) return start;
    statistics_.cells.reset();  // the cells' statistics do not describe this tree
    note("climbing by E", climbed);
    return climbed;
  }

  CsgTree better_start() {
    CsgTree merged = simplify(by_partitions_->tree);
    const CsgTree& of_cells = *by_cells_->tree;
    const bool only_cells_are_bounded =
        by_cells_->is_unbounded(merged) && !is_constant(of_cells) && !by_cells_->is_unbounded(of_cells);
    if (only_cells_are_bounded || objective_of(of_cells) >= objective_of(merged)) return take_cells();
    take_partitions();
    return merged;
  }

  double objective_of(const CsgTree& tree) {
    Stopwatch watch;
    const double objective = fit_of(tree).objective;
    statistics_.seconds.search += watch.lap();
    return objective;
  }

  /// Local search by E over all points (every k-th in a large cloud) and the supported primitives. Not applied where
  /// the points support the cells, since E does not see missing points.
  CsgTree climb(const CsgTree& start) {
    const SupportedPrimitives& supported = by_cells_->supported;
    RunContext run = run_.search();
    if (by_partitions_->partitions.size() > 1) run.on_progress = {};  // progress counts partitions
    const bool knows_all = std::ranges::includes(supported.original, primitives_of(start));
    if (is_constant(start) || !knows_all || supported.size() > RankClasses::k_byte_limit) return start;
    run_.enforce_limit();
    if (run.stop.stop_requested()) {
      statistics_.complete = false;
      return start;
    }
    Stopwatch watch;
    const RankClasses table = build_table_over(supported.primitives, cloud_, scale_, options_, true, without_stop(run));
    const CsgTree local = localised(start, supported.original);
    const Evolution climbed = local_search(table, local, {.work_limit = k_climbing_work}, run);
    statistics_.complete = statistics_.complete && climbed.complete;
    statistics_.seconds.search += watch.lap();
    CsgTree tree = renumber(simplify(climbed.tree), supported.original);
    return is_constant(tree) || by_cells_->is_unbounded(tree) ? start : tree;
  }

  void note(const char* step, const CsgTree& tree) { statistics_.steps.push_back({step, tree.size()}); }

  [[nodiscard]] FitStatistics fit_of(const CsgTree& tree) const {
    const std::vector<std::uint32_t>& order = by_partitions_ ? by_partitions_->order : by_cells_->complex.order;
    return measure_fit({.primitives = input_, .tree = tree}, cloud_, scale_.noise, options_, without_stop(run_.pass()),
                       order);
  }

  CsgTree simplified(const CsgTree& tree) {
    Stopwatch watch;
    statistics_.before_simplification = statistics_of(tree, input_);
    CsgTree result = simplify(tree);
    statistics_.tree = statistics_of(result, input_);
    note("simplification", result);
    statistics_.seconds.simplify += watch.lap();
    return result;
  }

  void finish(const CsgTree& tree) {
    if (!primitives_of(tree).empty()) {
      statistics_.fit = fit_of(tree);
      if (statistics_.cells) describe_cells();
      append(statistics_.warnings, search_warnings(statistics_));
    }
    statistics_.verdict = judge_fit({.primitives = input_, .tree = tree}, statistics_.fit, cloud_.positions);
  }

  /// Adds statistics that the extraction by cells does not need.
  void describe_cells() {
    const RunContext run = without_stop(run_.pass());
    statistics_.cells->open_volume = open_volume(*by_cells_, bounds_of(cloud_.positions), run);
    if (!statistics_.clique_histogram.empty()) return;
    const OverlapGraph graph = overlap_graph_of(cloud_, by_cells_->supported.primitives, scale_, options_, run);
    statistics_.clique_histogram = clique_histogram(maximal_cliques(graph));
    statistics_.components = connected_components(graph).size();
  }

  const PointCloud& cloud_;
  const PrimitiveSet& input_;
  ExtractOptions options_;
  ExtractionRun run_;
  ExtractStatistics statistics_;
  NoiseScale scale_{};
  std::optional<CellExtraction> by_cells_;
  std::optional<PartitionExtraction> by_partitions_;
};

}  // namespace

StageSeconds& StageSeconds::operator+=(const StageSeconds& other) {
  for (double StageSeconds::*stage :
       {&StageSeconds::read, &StageSeconds::clean, &StageSeconds::normals, &StageSeconds::detect, &StageSeconds::solids,
        &StageSeconds::segment, &StageSeconds::overlap, &StageSeconds::partition, &StageSeconds::classes,
        &StageSeconds::search, &StageSeconds::merge, &StageSeconds::simplify, &StageSeconds::refine,
        &StageSeconds::write, &StageSeconds::extraction, &StageSeconds::total}) {
    this->*stage += other.*stage;
  }
  return *this;
}

TreeStatistics statistics_of(const CsgTree& tree, const PrimitiveSet& primitives) {
  TreeStatistics statistics{
      .size = tree.size(), .leaves = leaf_count(tree), .depth = depth(tree), .levels = levels(tree)};
  for (const CsgNode& node : tree.nodes()) {
    if (!node.is_leaf()) continue;
    const Primitive& primitive = primitives[node.primitive()];
    statistics.price += price_of(primitive);
    statistics.operations += profile_of(primitive.shape) != nullptr ? 1 : 0;
  }
  statistics.price = std::round(10 * statistics.price) / 10;  // all prices are tenths
  statistics.operations += statistics.leaves > 0 ? statistics.leaves - 1 : 0;
  return statistics;
}

Extraction extract_csg(const PointCloud& cloud, const PrimitiveSet& primitives, const ExtractOptions& options,
                       const RunContext& run) {
  validate(options);
  check_input(cloud, primitives);
  const TimeLimit limit(run.stop, options.time_limit_seconds);
  RunContext inner = run;
  inner.threads = run.threads > 0 ? run.threads : usable_threads(run);
  oneapi::tbb::task_arena arena(usable_threads(run));
  const auto extract = [&](const PointCloud& points, const PrimitiveSet& solids) {
    return arena.execute([&] { return Extractor(points, solids, options, inner, limit).extract(); });
  };
  const Eigen::Vector3d origin = frame_origin(cloud.positions);
  if (origin.isZero(0)) return extract(cloud, primitives);
  return moved_back(extract(seen_from(cloud, origin), seen_from(primitives, origin)), origin, primitives);
}

}  // namespace cloud2csg
