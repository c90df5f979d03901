#include <algorithm>
#include <atomic>
#include <mutex>

#include "cloud2csg/csg_tree.hpp"
#include "core/base/parallel.hpp"
#include "core/base/run.hpp"
#include "paper/merge/merge_component.hpp"
#include "paper/segment/supported_primitives.hpp"
#include "pipeline/extraction_run.hpp"

namespace cloud2csg {
namespace {

/// Random streams of component searches and joint searches; partition_item() gives those of partitions.
constexpr std::uint64_t k_component_items = std::uint64_t{1} << 40U;
constexpr std::uint64_t k_joint_items = std::uint64_t{1} << 41U;

/// By index in the larger set: the position in `members`.
std::vector<PrimitiveIndex> local_indices(std::span<const PrimitiveIndex> members, std::size_t primitives) {
  std::vector<PrimitiveIndex> local(primitives, 0);
  for (std::size_t i = 0; i < members.size(); ++i) local[members[i]] = static_cast<PrimitiveIndex>(i);
  return local;
}

class PartitionExtractor {
 public:
  PartitionExtractor(const PointCloud& cloud, const NoiseScale& scale, const ExtractOptions& options,
                     const ExtractionRun& run)
      : cloud_(cloud), scale_(scale), options_(options), run_(run) {}

  PartitionExtraction extract(const PrimitiveSet& input) {
    supported_ = take_all(input);
    while (!make_tables()) {
    }
    result_.warnings = supported_.warnings;
    result_.unassigned = tables_.pass.unassigned;
    result_.order = std::move(tables_.pass.order);
    result_.clique_histogram = clique_histogram(partitions_.cliques);
    result_.components = partitions_.components.size();
    run_.enforce_limit();
    solve_partitions();
    result_.tree = renumber(merge_components(), supported_.original);
    return std::move(result_);
  }

 private:
  /// Whether points support all primitives. Otherwise it drops the unsupported ones and must run again.
  bool make_tables() {
    Stopwatch watch;
    partitions_ = partition_primitives(cloud_, supported_.primitives, scale_, options_, run_.pass());
    result_.seconds.overlap += partitions_.overlap_seconds;
    result_.seconds.partition += partitions_.partition_seconds;
    watch.lap();
    tables_ = {};  // frees the old tables before building new ones
    tables_ = build_partition_tables(cloud_, supported_.primitives, partitions_, scale_, options_, run_.pass());
    const PointPass& pass = tables_.pass;
    const double wall = watch.lap();
    const double share = pass.segment_seconds / (pass.segment_seconds + pass.classes_seconds);
    result_.seconds.segment += wall * share;
    result_.seconds.classes += wall * (1 - share);
    const std::size_t before = supported_.size();
    supported_ = without_unsupported(std::move(supported_), pass.points_of_primitive);
    return supported_.size() == before;
  }

  /// Progress counts completed searches when there are several, and generations when there is one.
  [[nodiscard]] RunContext search_run() const {
    RunContext run = run_.search();
    if (partitions_.sets.size() > 1) run.on_progress = {};
    return run;
  }

  void solve_partitions() {
    Stopwatch watch;
    const std::size_t count = partitions_.sets.size();
    evolutions_.resize(count);
    std::atomic<std::size_t> done = 0;
    std::mutex reporting;
    const RunContext run = run_.partitions();
    run.report("search", 0, count, "partitions");
    for_each_index_in_arena(count, run, [&](std::size_t k) {
      evolutions_[k] =
          evolve_tree(tables_.pass.tables[k], options_.search, partition_item(partitions_.sets[k]), search_run());
      const std::lock_guard lock(reporting);
      run.report("search", ++done, count, "partitions");
    });
    for (std::size_t k = 0; k < count; ++k) note_partition(k);
    result_.seconds.search += watch.lap();
  }

  void note_partition(std::size_t k) {
    const RankClasses& table = tables_.pass.tables[k];
    const Evolution& evolution = evolutions_[k];
    PartitionStatistics partition{.points = table.point_count(),
                                  .classes = table.class_count(),
                                  .generations = evolution.generations,
                                  .evaluations = evolution.evaluations,
                                  .score = evolution.score,
                                  .tree_size = simplify(evolution.tree).size()};
    for (const PrimitiveIndex p : table.primitives()) partition.primitives.push_back(supported_.original[p]);
    result_.partitions.push_back(std::move(partition));
    result_.is_complete = result_.is_complete && evolution.complete;
  }

  /// Tree over the supported primitives: one per component, united.
  CsgTree merge_components() {
    Stopwatch watch;
    std::vector<CsgTree> trees;
    const std::size_t count = partitions_.components.size();
    for (std::size_t c = 0; c < count; ++c) {
      trees.push_back(merge_one(c));
      run_.pass().report("merge", c + 1, count, "components");
    }
    result_.seconds.merge += watch.lap();
    return unite_all(trees);
  }

  CsgTree merge_one(std::size_t c) {
    const std::vector<PrimitiveIndex>& primitives = partitions_.components[c];
    const Component component = make_component(c);
    const SolveJointly solve_jointly = [&](const Clique& both) { return solve_set(both, primitives); };
    const MergedComponent merged = merge_component(
        component, solve_jointly, {.search = options_.search, .polish = options_.polish, .item = k_component_items + c},
        search_run());
    take_merge_statistics(merged);
    return renumber(merged.tree, primitives);
  }

  [[nodiscard]] Component make_component(std::size_t c) const {
    const std::vector<PrimitiveIndex>& primitives = partitions_.components[c];
    const std::vector<PrimitiveIndex> local = local_indices(primitives, supported_.size());
    Component component{.primitives = primitives.size()};
    const std::vector<std::size_t>& sets = partitions_.sets_of[c];
    const auto has_points = [&](std::size_t k) { return tables_.pass.tables[k].point_count() > 0; };
    const bool some_have_points = std::ranges::any_of(sets, has_points);
    for (const std::size_t k : sets) {
      if (some_have_points && !has_points(k)) continue;  // without points, all trees are equally good
      Clique& clique = component.cliques.emplace_back();
      for (const PrimitiveIndex p : partitions_.sets[k]) clique.push_back(local[p]);
      component.trees.push_back(renumber(evolutions_[k].tree, clique));
    }
    std::size_t points = 0;
    for (const TableWindow& from : tables_.windows_of[c]) {
      const RankClasses& table = tables_.pass.tables[from.table];
      MergeWindow& window =
          component.windows.emplace_back(MergeWindow{.table = &table, .primitives = {}, .judged = from.judged});
      for (const PrimitiveIndex p : table.primitives()) window.primitives.push_back(local[p]);
      points += table.point_count();
    }
    component.alpha = resolve(options_.objective, points, scale_.noise).alpha;
    return component;
  }

  /// Solves a subset of a component by a pass over the points for it alone. Uses the component's indices.
  CsgTree solve_set(const Clique& set, std::span<const PrimitiveIndex> component) {
    PrimitiveSet members;
    for (const PrimitiveIndex p : set) members.push_back(supported_.primitives[component[p]]);
    const RankClasses table = build_table_over(members, cloud_, scale_, options_, false, without_stop(search_run()));
    const Evolution evolution = evolve_tree(table, options_.search, k_joint_items + joint_solutions_++, search_run());
    result_.is_complete = result_.is_complete && evolution.complete;
    return renumber(evolution.tree, set);
  }

  void take_merge_statistics(const MergedComponent& merged) {
    MergeStatistics& sum = result_.merge;
    const MergeStatistics& part = merged.statistics;
    sum.ways.insert(sum.ways.end(), part.ways.begin(), part.ways.end());
    sum.merges += part.merges;
    sum.blocked += part.blocked;
    sum.failed_checks += part.failed_checks;
    sum.joint_solutions += part.joint_solutions;
    sum.generations += part.generations;
    sum.evaluations += part.evaluations;
    sum.worst_shortfall = std::max(sum.worst_shortfall, part.worst_shortfall);
    result_.is_complete = result_.is_complete && merged.complete;
  }

  const PointCloud& cloud_;
  const NoiseScale& scale_;
  const ExtractOptions& options_;
  const ExtractionRun& run_;
  SupportedPrimitives supported_;
  Partitions partitions_;
  PartitionTables tables_;
  std::vector<Evolution> evolutions_;
  std::uint64_t joint_solutions_ = 0;
  PartitionExtraction result_;
};

}  // namespace

PartitionExtraction extract_by_partitions(const PointCloud& cloud, const PrimitiveSet& primitives,
                                          const NoiseScale& scale, const ExtractOptions& options,
                                          const ExtractionRun& run) {
  return PartitionExtractor(cloud, scale, options, run).extract(primitives);
}

}  // namespace cloud2csg
