#include "bench/experiment/reference_extraction.hpp"

#include <algorithm>
#include <limits>

#include "cloud2csg/advanced/merge.hpp"
#include "cloud2csg/advanced/simplify.hpp"
#include "core/base/parallel.hpp"
#include "core/base/stopwatch.hpp"
#include "paper/evolve/genetic_algorithm.hpp"
#include "paper/partition/partition.hpp"
#include "pipeline/fit.hpp"

namespace cloud2csg {
namespace {

/// The points that belong to one at least of some primitives, ascending.
std::vector<std::uint32_t> points_of(const Clique& clique, const Segmentation& segmentation) {
  std::vector<std::uint32_t> points;
  for (const PrimitiveIndex p : clique) {
    const std::vector<std::uint32_t>& more = segmentation.points_of[p];
    points.insert(points.end(), more.begin(), more.end());
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// All trees that use each of one or two primitives at most once, and their complements; smaller ones first.
std::vector<CsgTree> trees_of_few(std::size_t primitives) {
  const CsgTree a = CsgTree::leaf(0);
  if (primitives == 1) return {a, complement(a)};
  const CsgTree b = CsgTree::leaf(1);
  std::vector<CsgTree> trees{
      a, b, complement(a), complement(b), unite(a, b), intersect(a, b), subtract(a, b), subtract(b, a)};
  for (std::size_t i = 4; i < 8; ++i) trees.push_back(complement(trees[i]));
  return trees;
}

Evolution best_of_few(const TreeObjective& objective) {
  ObjectiveEvaluator evaluator(objective);
  Evolution best;
  best.score = -std::numeric_limits<double>::infinity();
  for (const CsgTree& tree : trees_of_few(objective.primitives)) {
    const double score = evaluator.score(tree);
    if (score <= best.score) continue;
    best.tree = tree;
    best.score = score;
  }
  best.geometry = evaluator.geometry(best.tree);
  best.evaluations = evaluator.evaluations();
  return best;
}

class ReferenceExtractor {
 public:
  ReferenceExtractor(const PointCloud& cloud, const PrimitiveSet& input, const ExtractOptions& options,
                     const RunContext& run)
      : cloud_(cloud), input_(input), options_(options), run_(run) {
    options_.search.seed = options.seed;
  }

  Extraction extract() {
    prepare_partitions();
    solve_partitions();
    Stopwatch watch;
    const CsgTree merged = merge();
    StageSeconds& seconds = statistics_.seconds;
    seconds.merge = watch.lap();
    const CsgTree tree = renumber(simplify(merged), prepared_.original);
    seconds.simplify = watch.lap();
    seconds.extraction =
        seconds.segment + seconds.overlap + seconds.partition + seconds.search + seconds.merge + seconds.simplify;
    seconds.total = seconds.extraction;
    statistics_.points = cloud_.size();
    statistics_.tree = statistics_of(tree);
    if (!primitives_of(tree).empty()) {
      const Objective objective = resolve(options_.objective, cloud_.size(), prepared_.scale.noise);
      statistics_.fit = measure_fit(tree, input_, cloud_, objective, prepared_.scale, run_);
    }
    return {.tree = tree, .statistics = std::move(statistics_)};
  }

 private:
  [[nodiscard]] RunContext with_threads_if(bool is_parallel) const {
    return {.stop = run_.stop, .on_progress = {}, .threads = is_parallel ? run_.threads : 1};
  }

  /// The graph and the cliques are timed by the preparation; its tables are not part of the paper's method, only their
  /// weights are taken, and the segmentation is made without them.
  void prepare_partitions() {
    const NoiseScale scale = measure_scale(cloud_, input_, options_, with_threads_if(false), statistics_);
    prepared_ = prepare(cloud_, input_, scale, options_, with_threads_if(false), statistics_);
    Stopwatch watch;
    segmentation_ = segment_points(cloud_, prepared_.primitives, prepared_.scale.tolerances,
                                   with_threads_if(options_.parallel != Parallel::none));
    statistics_.seconds.segment = watch.lap();
    statistics_.seconds.classes = 0;
  }

  void solve_partitions() {
    Stopwatch watch;
    evolutions_.resize(prepared_.partitions.size());
    const bool over_partitions = options_.parallel == Parallel::partitions || options_.parallel == Parallel::both;
    for_each_index_in_arena(evolutions_.size(), with_threads_if(over_partitions),
                            [this](std::size_t k) { evolutions_[k] = solve(k); });
    statistics_.seconds.search = watch.lap();
    for (std::size_t k = 0; k < evolutions_.size(); ++k) {
      statistics_.partitions.push_back({.points = prepared_.pass.tables[k].point_count(),
                                        .generations = evolutions_[k].generations,
                                        .evaluations = evolutions_[k].evaluations,
                                        .score = evolutions_[k].score});
      statistics_.complete = statistics_.complete && evolutions_[k].complete;
    }
  }

  [[nodiscard]] Evolution solve(std::size_t k) const {
    const Clique& clique = prepared_.partitions[k];
    PrimitiveSet members;
    for (const PrimitiveIndex p : clique) members.push_back(prepared_.primitives[p]);
    const std::vector<std::uint32_t> points = points_of(clique, segmentation_);
    const Objective weights = prepared_.pass.tables[k].objective();
    const Objective without_cost{.alpha = 0, .beta = weights.beta, .gamma = weights.gamma};
    const TreeObjective objective{
        .primitives = clique.size(),
        .geometry =
            [&](const CsgTree& tree) { return reference_objective(tree, members, cloud_, points, without_cost); },
        .alpha = weights.alpha};
    if (clique.size() <= 2) return best_of_few(objective);
    const bool over_population = options_.parallel == Parallel::population || options_.parallel == Parallel::both;
    return run_genetic_algorithm(objective, {}, options_.search, partition_item(clique),
                                 with_threads_if(over_population));
  }

  /// The paper's merge in each component; trees that it leaves apart are united.
  CsgTree merge() {
    std::vector<CsgTree> components;
    for (std::size_t c = 0; c < prepared_.components.size(); ++c) {
      std::vector<CsgTree> trees;
      for (std::size_t k = 0; k < evolutions_.size(); ++k) {
        if (prepared_.component_of[k] == c) trees.push_back(renumber(evolutions_[k].tree, prepared_.partitions[k]));
      }
      const MergeResult merged = merge_trees(trees, MergeOrder::paper, run_);
      statistics_.merge.merges += merged.merges;
      statistics_.merge.blocked += merged.blocked;
      statistics_.merge.ways.push_back(trees.size() == 1 ? MergeWay::single : MergeWay::paper);
      components.push_back(unite_all(merged.trees));
    }
    return unite_all(components);
  }

  const PointCloud& cloud_;
  const PrimitiveSet& input_;
  ExtractOptions options_;
  const RunContext& run_;
  ExtractStatistics statistics_;
  Preparation prepared_;
  Segmentation segmentation_;
  std::vector<Evolution> evolutions_;
};

}  // namespace

Extraction reference_extraction(const PointCloud& cloud, const PrimitiveSet& primitives, const ExtractOptions& options,
                                const RunContext& run) {
  oneapi::tbb::task_arena arena(usable_threads(run));
  return arena.execute([&] { return ReferenceExtractor(cloud, primitives, options, run).extract(); });
}

}  // namespace cloud2csg
