#include "cloud2csg/extract.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>

#include "cloud2csg/advanced/simplify.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/without_stop.hpp"
#include "paper/merge/merge_component.hpp"
#include "paper/partition/partition.hpp"
#include "pipeline/cell_extraction.hpp"
#include "pipeline/fit.hpp"
#include "pipeline/time_limit.hpp"

namespace cloud2csg {
namespace {

/// Random streams of searches over components and of joint searches; those of partitions are named by their primitives.
constexpr std::uint64_t k_component_items = std::uint64_t{1} << 40U;
constexpr std::uint64_t k_joint_items = std::uint64_t{1} << 41U;

/// Of climbing by E, in evaluations x classes x nodes: about a second.
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
    throw Error({.file = {}, .where = {}, .expected = expected, .remedy = remedy});
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

/// Local indices of the primitives of a table, by index in the prepared set.
std::vector<PrimitiveIndex> local_indices(std::span<const PrimitiveIndex> members, std::size_t primitives) {
  std::vector<PrimitiveIndex> local(primitives, 0);
  for (std::size_t i = 0; i < members.size(); ++i) local[members[i]] = static_cast<PrimitiveIndex>(i);
  return local;
}

class Extractor {
 public:
  /// `run` holds for all; the search, which always has a tree to give, also stops at the limit.
  Extractor(const PointCloud& cloud, const PrimitiveSet& input, const ExtractOptions& options, const RunContext& run,
            const TimeLimit& limit)
      : cloud_(cloud), input_(input), options_(options), run_(run), limit_(limit) {
    options_.search.seed = options.seed;
  }

  Extraction extract() {
    Stopwatch total;
    statistics_.strategy = options_.strategy;
    statistics_.parallel = options_.parallel;
    statistics_.threads = run_.threads;
    statistics_.seed = options_.seed;
    statistics_.points = cloud_.size();
    statistics_.primitives = input_.size();
    const RunContext pass_run = with_threads(options_.parallel == Parallel::none ? 1 : run_.threads);
    scale_ = measure_scale(cloud_, input_, options_, pass_run, statistics_);
    std::optional<CsgTree> tree = solve_by_cells(pass_run);
    if (!tree) tree = solve_by_partitions(pass_run);
    const CsgTree result = simplified(*tree);
    statistics_.seconds.extraction = total.lap();
    finish(result, pass_run);
    statistics_.seconds.total = statistics_.seconds.extraction + total.lap();
    return {.tree = result, .statistics = std::move(statistics_)};
  }

 private:
  [[nodiscard]] RunContext with_threads(int threads) const {
    RunContext run = run_;
    run.threads = threads;
    return run;
  }

  /// The tree of the cells where it is asked for, or the points bear it out. Else none, and it is kept for comparison.
  std::optional<CsgTree> solve_by_cells(const RunContext& run) {
    const bool is_asked_for = options_.strategy == Strategy::cells;
    if (!is_asked_for && (options_.strategy != Strategy::automatic || options_.cell_trust > 1)) return std::nullopt;
    by_cells_ = extract_by_cells(cloud_, input_, scale_, options_, run, search_run(), statistics_.seconds);
    limit_.enforce();
    if (!by_cells_) {
      if (is_asked_for) {
        statistics_.warnings.emplace_back(
            "the cells leave more than 64 primitives that depend on each other: partitions were searched instead");
      }
      return std::nullopt;
    }
    if (!is_asked_for && by_cells_->trust() < options_.cell_trust) return std::nullopt;
    return take_cells();
  }

  CsgTree take_cells() {
    statistics_.cells = by_cells_->statistics;
    statistics_.unassigned_points = by_cells_->complex.unassigned;
    statistics_.warnings = by_cells_->warnings;
    statistics_.complete = statistics_.complete && by_cells_->is_complete;
    statistics_.steps = by_cells_->steps;
    order_ = std::move(by_cells_->complex.order);
    return by_cells_->tree;
  }

  CsgTree solve_by_partitions(const RunContext& run) {
    prepared_ = prepare(cloud_, input_, scale_, options_, run, statistics_);
    order_ = std::move(prepared_.pass.order);
    limit_.enforce();
    solve_partitions();
    CsgTree tree = renumber(merge_components(), prepared_.original);
    note("merged partitions", tree);
    if (!by_cells_) return tree;
    tree = simplify(tree);
    const auto objective_of = [&](const CsgTree& some) {
      Stopwatch watch;
      const double objective = fit_of(some, run).objective;
      statistics_.seconds.search += watch.lap();
      return objective;
    };
    const bool only_cells_are_bounded =
        is_unbounded(tree) && !is_constant(by_cells_->tree) && !is_unbounded(by_cells_->tree);
    double objective = objective_of(tree);
    if (const double of_cells = objective_of(by_cells_->tree); only_cells_are_bounded || of_cells >= objective) {
      tree = take_cells();
      objective = of_cells;
    }
    if (!options_.polish) return tree;
    CsgTree climbed = climb(tree);
    if (climbed == tree || objective_of(climbed) <= objective) return tree;
    statistics_.cells.reset();  // it is not their tree any more
    note("climbing by E", climbed);
    return climbed;
  }

  /// By E over all points, or of a large cloud every k-th. Not where the points bear the cells out: E does not see what
  /// they lack. The primitives that points support only.
  CsgTree climb(const CsgTree& start) {
    const SupportedPrimitives& supported = by_cells_->supported;
    const RunContext run = search_run();
    const bool knows_all = std::ranges::includes(supported.original, primitives_of(start));
    if (is_constant(start) || !knows_all || supported.original.size() > RankClasses::k_byte_limit) return start;
    limit_.enforce();
    if (run.stop.stop_requested()) {
      statistics_.complete = false;
      return start;
    }
    Stopwatch watch;
    const PointPass pass = pass_over(supported.primitives, true);
    const CsgTree local = renumber(start, local_indices(supported.original, input_.size()));
    const Evolution climbed = local_search(pass.tables.front(), local, {.work_limit = k_climbing_work}, run);
    statistics_.complete = statistics_.complete && climbed.complete;
    statistics_.seconds.search += watch.lap();
    CsgTree tree = renumber(simplify(climbed.tree), supported.original);
    return is_constant(tree) || is_unbounded(tree) ? start : tree;
  }

  void note(const char* step, const CsgTree& tree) { statistics_.steps.push_back({step, tree.size()}); }

  [[nodiscard]] bool is_unbounded(const CsgTree& tree) const {
    const CellComplex& complex = by_cells_->complex;
    return std::ranges::any_of(complex.unbounded, [&](CellIndex cell) {
      std::vector<bool> is_inside(input_.size());
      for (const PrimitiveIndex p : complex.cells[cell]) is_inside[by_cells_->supported.original[p]] = true;
      return contains(tree, is_inside);
    });
  }

  /// A table of its own for some primitives: the pass looks at no other.
  [[nodiscard]] PointPass pass_over(const PrimitiveSet& members, bool all_points) const {
    RankClassesRequest request;
    request.primitives.resize(members.size());
    request.stride = stride_for(members.size(), cloud_.size());
    request.all_points = all_points;
    std::iota(request.primitives.begin(), request.primitives.end(), PrimitiveIndex{0});
    return build_rank_classes(cloud_, members, std::span(&request, 1),
                              {.tolerances = scale_.tolerances,
                               .objective = options_.objective,
                               .noise = scale_.noise,
                               .precision = options_.precision},
                              without_stop(search_run()));
  }

  [[nodiscard]] FitStatistics fit_of(const CsgTree& tree, const RunContext& run) const {
    const Objective objective = resolve(options_.objective, cloud_.size(), scale_.noise);
    return measure_fit(tree, input_, cloud_, objective, scale_, without_stop(run), order_);
  }

  /// How a single search runs: its population in parallel, or not.
  [[nodiscard]] RunContext search_run() const {
    const bool over_population = options_.parallel == Parallel::population || options_.parallel == Parallel::both;
    RunContext run = with_threads(over_population ? run_.threads : 1);
    // Of several searches at once, those that have ended are counted; a single one tells its generations.
    if (prepared_.partitions.size() > 1) run.on_progress = {};
    run.stop = limit_.token();
    return run;
  }

  void solve_partitions() {
    Stopwatch watch;
    const std::size_t count = prepared_.partitions.size();
    evolutions_.resize(count);
    std::atomic<std::size_t> done = 0;
    std::mutex reporting;
    run_.report("search", 0, count, "partitions");
    const auto solve = [&](std::size_t k) {
      evolutions_[k] =
          evolve_tree(prepared_.pass.tables[k], options_.search, partition_item(prepared_.partitions[k]), search_run());
      const std::lock_guard lock(reporting);
      run_.report("search", ++done, count, "partitions");
    };
    const bool over_partitions = options_.parallel == Parallel::partitions || options_.parallel == Parallel::both;
    for_each_index_in_arena(count, with_threads(over_partitions ? run_.threads : 1), solve);
    for (std::size_t k = 0; k < count; ++k) note_partition(k);
    statistics_.seconds.search += watch.lap();
  }

  void note_partition(std::size_t k) {
    const RankClasses& table = prepared_.pass.tables[k];
    const Evolution& evolution = evolutions_[k];
    PartitionStatistics partition{.points = table.point_count(),
                                  .classes = table.class_count(),
                                  .generations = evolution.generations,
                                  .evaluations = evolution.evaluations,
                                  .score = evolution.score,
                                  .tree_size = simplify(evolution.tree).size()};
    for (const PrimitiveIndex p : table.primitives()) partition.primitives.push_back(prepared_.original[p]);
    statistics_.partitions.push_back(std::move(partition));
    statistics_.complete = statistics_.complete && evolution.complete;
  }

  /// The tree over the prepared primitives: a tree a component, united.
  CsgTree merge_components() {
    Stopwatch watch;
    std::vector<CsgTree> trees;
    for (std::size_t c = 0; c < prepared_.components.size(); ++c) {
      trees.push_back(merge_one(c));
      run_.report("merge", c + 1, prepared_.components.size(), "components");
    }
    statistics_.seconds.merge += watch.lap();
    return unite_all(trees);
  }

  CsgTree merge_one(std::size_t c) {
    const std::vector<PrimitiveIndex>& primitives = prepared_.components[c];
    const Component component = make_component(c);
    const SolveJointly solve_jointly = [&](const Clique& both) { return solve_set(both, primitives); };
    const MergedComponent merged = merge_component(
        component, solve_jointly, {.search = options_.search, .polish = options_.polish, .item = k_component_items + c},
        search_run());
    take_merge_statistics(merged);
    return renumber(merged.tree, primitives);
  }

  [[nodiscard]] Component make_component(std::size_t c) const {
    const std::vector<PrimitiveIndex>& primitives = prepared_.components[c];
    const std::vector<PrimitiveIndex> local = local_indices(primitives, prepared_.primitives.size());
    Component component{.primitives = primitives.size()};
    const std::vector<std::size_t>& partitions = prepared_.partitions_of[c];
    const auto has_points = [&](std::size_t k) { return prepared_.pass.tables[k].point_count() > 0; };
    const bool some_have_points = std::ranges::any_of(partitions, has_points);
    for (const std::size_t k : partitions) {
      if (some_have_points && !has_points(k)) continue;  // without points, any tree is as good as another
      Clique& clique = component.cliques.emplace_back();
      for (const PrimitiveIndex p : prepared_.partitions[k]) clique.push_back(local[p]);
      component.trees.push_back(renumber(evolutions_[k].tree, clique));
    }
    std::size_t points = 0;
    for (const TableWindow& from : prepared_.windows_of[c]) {
      const RankClasses& table = prepared_.pass.tables[from.table];
      MergeWindow& window =
          component.windows.emplace_back(MergeWindow{.table = &table, .primitives = {}, .judged = from.judged});
      for (const PrimitiveIndex p : table.primitives()) window.primitives.push_back(local[p]);
      points += table.point_count();
    }
    component.alpha = resolve(options_.objective, points, scale_.noise).alpha;
    return component;
  }

  /// A tree for some primitives of a component, from a pass over the points for just them; component's indices.
  CsgTree solve_set(const Clique& set, std::span<const PrimitiveIndex> component) {
    PrimitiveSet members;
    for (const PrimitiveIndex p : set) members.push_back(prepared_.primitives[component[p]]);
    const PointPass pass = pass_over(members, false);
    const Evolution evolution =
        evolve_tree(pass.tables.front(), options_.search, k_joint_items + joint_solutions_++, search_run());
    statistics_.complete = statistics_.complete && evolution.complete;
    return renumber(evolution.tree, set);
  }

  void take_merge_statistics(const MergedComponent& merged) {
    MergeStatistics& sum = statistics_.merge;
    const MergeStatistics& part = merged.statistics;
    sum.ways.insert(sum.ways.end(), part.ways.begin(), part.ways.end());
    sum.merges += part.merges;
    sum.blocked += part.blocked;
    sum.failed_checks += part.failed_checks;
    sum.joint_solutions += part.joint_solutions;
    sum.generations += part.generations;
    sum.evaluations += part.evaluations;
    sum.worst_shortfall = std::max(sum.worst_shortfall, part.worst_shortfall);
    statistics_.complete = statistics_.complete && merged.complete;
  }

  CsgTree simplified(const CsgTree& tree) {
    Stopwatch watch;
    statistics_.before_simplification = statistics_of(tree);
    CsgTree result = simplify(tree);
    statistics_.tree = statistics_of(result);
    note("simplification", result);
    statistics_.seconds.simplify += watch.lap();
    return result;
  }

  void finish(const CsgTree& tree, const RunContext& run) {
    if (primitives_of(tree).empty()) {
      statistics_.warnings.emplace_back("the result is empty: no formula over the primitives explains the points");
      return;
    }
    statistics_.fit = fit_of(tree, run);
    if (statistics_.cells) describe_cells(run);
    if (10 * statistics_.unassigned_points > statistics_.points) {
      statistics_.warnings.emplace_back(
          "more than a tenth of the points is on no primitive: primitives may be missing or badly fitted");
    } else if (statistics_.fit.p95_distance > scale_.tolerances.distance) {
      statistics_.warnings.push_back(
          fmt::format("more than a twentieth of the points is farther than {:.3g} from the surface of the result: "
                      "primitives may be missing or badly fitted",
                      scale_.tolerances.distance));
    }
    if (!statistics_.cells && statistics_.merge.worst_shortfall > k_tolerated_shortfall) {
      statistics_.warnings.push_back(
          fmt::format("the trees of the partitions did not merge well: on one of the primitives, {:.0f} % of what its "
                      "partition explains is lost",
                      100 * statistics_.merge.worst_shortfall));
    }
    if (!statistics_.complete) statistics_.warnings.emplace_back("stopped early: this is the best tree so far");
  }

  /// What the way by cells does without, and who reads the statistics wants to see.
  void describe_cells(const RunContext& run) {
    const RunContext to_the_end = without_stop(run);
    statistics_.cells->open_volume = open_volume(*by_cells_, bounds_of(cloud_.positions), to_the_end);
    if (!statistics_.clique_histogram.empty()) return;
    const OverlapGraph graph = overlap_graph_of(cloud_, by_cells_->supported.primitives, scale_, options_, to_the_end);
    statistics_.clique_histogram = clique_histogram(maximal_cliques(graph));
    statistics_.components = connected_components(graph).size();
  }

  const PointCloud& cloud_;
  const PrimitiveSet& input_;
  ExtractOptions options_;
  const RunContext& run_;
  const TimeLimit& limit_;
  ExtractStatistics statistics_;
  NoiseScale scale_{};
  std::optional<CellExtraction> by_cells_;
  Preparation prepared_;
  std::vector<std::uint32_t> order_;  // of the points: neighbours are near each other
  std::vector<Evolution> evolutions_;
  std::uint64_t joint_solutions_ = 0;
};

}  // namespace

TreeStatistics statistics_of(const CsgTree& tree) {
  return {.size = tree.size(), .leaves = leaf_count(tree), .depth = depth(tree), .levels = levels(tree)};
}

Extraction extract_csg(const PointCloud& cloud, const PrimitiveSet& primitives, const ExtractOptions& options,
                       const RunContext& run) {
  validate(options);
  check_input(cloud, primitives);
  const TimeLimit limit(run.stop, options.time_limit_seconds);
  RunContext inner = run;
  inner.threads = run.threads > 0 ? run.threads : usable_threads(run);
  oneapi::tbb::task_arena arena(usable_threads(run));
  return arena.execute([&] { return Extractor(cloud, primitives, options, inner, limit).extract(); });
}

}  // namespace cloud2csg
