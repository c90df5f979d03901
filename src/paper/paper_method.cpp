#include "paper/paper_method.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "cloud2csg/advanced/merge.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/base/parallel.hpp"
#include "core/base/run.hpp"
#include "paper/evolve/genetic_algorithm.hpp"
#include "paper/objective/objective.hpp"
#include "paper/partition/partitions.hpp"
#include "paper/segment/supported_primitives.hpp"

namespace cloud2csg {
namespace {

/// S: the points that belong to at least one of some primitives, ascending.
std::vector<std::uint32_t> points_of(const Clique& partition, const Segmentation& segmentation) {
  std::vector<std::uint32_t> points;
  for (const PrimitiveIndex p : partition) {
    const std::vector<std::uint32_t>& more = segmentation.points_of[p];
    points.insert(points.end(), more.begin(), more.end());
  }
  std::ranges::sort(points);
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
  TreeEvaluator evaluator(objective);
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

class PaperMethod {
 public:
  PaperMethod(const PointCloud& cloud, const PrimitiveSet& input, const ExtractOptions& options, const RunContext& run)
      : cloud_(cloud), input_(input), options_(options), run_(run) {
    options_.search.seed = options.seed;
  }

  Extraction extract() {
    segment();
    partition();
    solve_partitions();
    Stopwatch watch;
    const CsgTree merged = merge();
    StageSeconds& seconds = statistics_.seconds;
    seconds.merge = watch.lap();
    const CsgTree tree = renumber(simplify(merged), supported_.original);
    seconds.simplify = watch.lap();
    seconds.extraction =
        seconds.segment + seconds.overlap + seconds.partition + seconds.search + seconds.merge + seconds.simplify;
    seconds.total = seconds.extraction;
    statistics_.points = cloud_.size();
    statistics_.tree = statistics_of(tree, input_);
    if (!primitives_of(tree).empty()) {
      statistics_.fit = measure_fit({.primitives = input_, .tree = tree}, cloud_, scale_.noise, options_, run_);
    }
    return {.model = {.primitives = input_, .tree = tree}, .statistics = std::move(statistics_)};
  }

 private:
  /// Points belong to the primitives that they are near. Primitives without points are left out.
  void segment() {
    scale_ = measure_noise_scale(cloud_, input_, options_.segmentation, with_threads_if(false));
    Stopwatch watch;
    supported_ = take_all(input_);
    segmentation_ =
        segment_points(cloud_, input_, scale_.tolerances, with_threads_if(options_.parallel != Parallel::none));
    statistics_.seconds.segment = watch.lap();
    std::vector<std::size_t> counts;
    for (const std::vector<std::uint32_t>& points : segmentation_.points_of) counts.push_back(points.size());
    supported_ = without_unsupported(std::move(supported_), counts);
    std::erase_if(segmentation_.points_of, [](const std::vector<std::uint32_t>& points) { return points.empty(); });
    statistics_.noise = scale_.noise;
    statistics_.warnings = supported_.warnings;
    statistics_.unassigned_points = segmentation_.unassigned;
  }

  /// Partitions are the maximal cliques of the overlap graph.
  void partition() {
    partitions_ = partition_primitives(cloud_, supported_.primitives, scale_, options_, with_threads_if(false));
    statistics_.seconds.overlap = partitions_.overlap_seconds;
    statistics_.seconds.partition = partitions_.partition_seconds;
    statistics_.clique_histogram = clique_histogram(partitions_.cliques);
    statistics_.components = partitions_.components.size();
  }

  void solve_partitions() {
    Stopwatch watch;
    evolutions_.resize(partitions_.sets.size());
    statistics_.partitions.resize(partitions_.sets.size());
    const bool over_partitions = options_.parallel == Parallel::partitions || options_.parallel == Parallel::both;
    for_each_index_in_arena(evolutions_.size(), with_threads_if(over_partitions), [this](std::size_t k) { solve(k); });
    statistics_.seconds.search = watch.lap();
    for (const Evolution& evolution : evolutions_) statistics_.complete = statistics_.complete && evolution.complete;
  }

  /// Lists all trees over one or two primitives. Over more, the genetic algorithm looks for the highest E(t).
  void solve(std::size_t k) {
    const Clique& partition = partitions_.sets[k];
    PrimitiveSet members;
    for (const PrimitiveIndex p : partition) members.push_back(supported_.primitives[p]);
    const std::vector<std::uint32_t> points = points_of(partition, segmentation_);
    const Objective weights = resolve(options_.objective, points.size(), scale_.noise);
    const Objective without_cost{.alpha = 0, .beta = weights.beta, .gamma = weights.gamma};
    const TreeObjective objective{
        .primitives = partition.size(),
        .geometry =
            [&](const CsgTree& tree) { return reference_objective(tree, members, cloud_, points, without_cost); },
        .alpha = weights.alpha};
    const bool over_population = options_.parallel == Parallel::population || options_.parallel == Parallel::both;
    evolutions_[k] = partition.size() <= 2
                         ? best_of_few(objective)
                         : run_genetic_algorithm(objective, {}, options_.search, partition_item(partition),
                                                 with_threads_if(over_population));
    statistics_.partitions[k] = {.points = points.size(),
                                 .generations = evolutions_[k].generations,
                                 .evaluations = evolutions_[k].evaluations,
                                 .score = evolutions_[k].score};
  }

  /// Merges the trees of the partitions into one a component, and unites trees that the merge leaves apart.
  CsgTree merge() {
    std::vector<CsgTree> components;
    for (std::size_t c = 0; c < partitions_.components.size(); ++c) {
      std::vector<CsgTree> trees;
      for (const std::size_t k : partitions_.sets_of[c]) {
        trees.push_back(renumber(evolutions_[k].tree, partitions_.sets[k]));
      }
      const MergeResult merged = merge_trees(trees, MergeOrder::paper, run_);
      statistics_.merge.merges += merged.merges;
      statistics_.merge.blocked += merged.blocked;
      statistics_.merge.ways.push_back(trees.size() == 1 ? MergeWay::single : MergeWay::paper);
      components.push_back(unite_all(merged.trees));
    }
    return unite_all(components);
  }

  [[nodiscard]] RunContext with_threads_if(bool is_parallel) const {
    return {.stop = run_.stop, .on_progress = {}, .threads = is_parallel ? run_.threads : 1};
  }

  const PointCloud& cloud_;
  const PrimitiveSet& input_;
  ExtractOptions options_;
  const RunContext& run_;
  ExtractStatistics statistics_;
  NoiseScale scale_{};
  SupportedPrimitives supported_;
  Segmentation segmentation_;
  Partitions partitions_;
  std::vector<Evolution> evolutions_;
};

}  // namespace

Extraction extract_as_in_paper(const PointCloud& cloud, const PrimitiveSet& primitives, const ExtractOptions& options,
                               const RunContext& run) {
  oneapi::tbb::task_arena arena(usable_threads(run));
  return arena.execute([&] { return PaperMethod(cloud, primitives, options, run).extract(); });
}

}  // namespace cloud2csg
