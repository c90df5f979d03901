#include "cloud2csg/advanced/evolve.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/tree/local_search.hpp"
#include "paper/evolve/genetic_algorithm.hpp"
#include "paper/evolve/listing.hpp"

namespace cloud2csg {
namespace {

constexpr std::uint64_t k_restart_stage = 0x6761'0003;  // names the random streams of restarts

void count_in(Evolution& total, const Evolution& part) {
  total.generations += part.generations;
  total.evaluations += part.evaluations;
  total.complete = total.complete && part.complete;
}

/// Takes the tree of `part` when it is better, and counts its work in any case.
void improve(Evolution& total, const Evolution& part) {
  count_in(total, part);
  if (part.score <= total.score) return;
  total.tree = part.tree;
  total.score = part.score;
  total.geometry = part.geometry;
}

Evolution nothing_yet() {
  Evolution evolution;
  evolution.score = -std::numeric_limits<double>::infinity();
  return evolution;
}

/// Starts of a local search that knows nothing: each primitive alone, and the union of all.
std::vector<CsgTree> simple_trees(std::size_t primitives) {
  std::vector<CsgTree> leaves;
  for (PrimitiveIndex p = 0; p < primitives; ++p) leaves.push_back(CsgTree::leaf(p));
  std::vector<CsgTree> trees{unite_all(leaves)};
  trees.insert(trees.end(), leaves.begin(), leaves.end());
  return trees;
}

constexpr std::size_t k_local_searches = 4;

/// The best few simple trees, each improved by a local search.
Evolution seed_by_local_search(const RankClasses& table, const RunContext& run, std::vector<CsgTree>& seeds) {
  RankScratch scratch;
  std::vector<CsgTree> starts = simple_trees(table.primitive_count());
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < starts.size(); ++i) order.emplace_back(-table.score(starts[i], scratch), i);
  std::sort(order.begin() + 1, order.end());
  Evolution best = local_search(table, starts.front(), {}, run);
  seeds.push_back(best.tree);
  for (std::size_t k = 1; k < std::min(order.size(), k_local_searches); ++k) {
    const Evolution found = local_search(table, starts[order[k].second], {}, run);
    seeds.push_back(found.tree);
    improve(best, found);
  }
  return best;
}

/// Runs the genetic algorithm, then a local search on its best tree. Repeats from there while that improves the tree.
void climb(const RankClasses& table, std::vector<CsgTree> seeds, const GaOptions& options, std::uint64_t item,
           const RunContext& run, Evolution& best) {
  constexpr int k_rounds = 4;
  for (int round = 0; round < k_rounds; ++round) {
    GaOptions round_options = options;
    round_options.seed += static_cast<std::uint64_t>(round) << 32U;
    improve(best, run_genetic_algorithm(objective_on(table), seeds, round_options, item, run));
    if (!options.polish || !best.complete) return;
    const double before = best.score;
    improve(best, local_search(table, best.tree, {}, run));
    if (best.score <= before) return;
    seeds.push_back(best.tree);
  }
}

bool is_believed(const Evolution& best, const RankClasses& table, const GaOptions& options) {
  return best.geometry >= options.trust * table.geometry_bound();
}

/// No more leaves than primitives, and believed on the points nearest to each: a better tree is unlikely.
bool is_believed_everywhere(const Evolution& best, const RankClasses& table, const GaOptions& options) {
  if (options.trust <= 0 || leaf_count(best.tree) > table.primitive_count()) return false;
  RankScratch scratch;
  const std::vector<double> reached = table.sums_by_nearest(table.class_scores(best.tree, scratch));
  const std::vector<double> bounds = table.sums_by_nearest(table.class_bounds());
  for (std::size_t p = 0; p < bounds.size(); ++p) {
    // A shortfall below the cost of a node is noise.
    if (reached[p] < options.trust * bounds[p] && bounds[p] - reached[p] > table.objective().alpha) return false;
  }
  return true;
}

/// Climbs from the seeds, then from random trees only, until a tree is believed or the budget is spent.
void search(const RankClasses& table, std::vector<CsgTree> seeds, const GaOptions& options, std::uint64_t item,
            const RunContext& run, Evolution& best) {
  climb(table, std::move(seeds), options, item, run, best);
  for (int restart = 1; restart <= options.restarts; ++restart) {
    if (!best.complete || is_believed(best, table, options) || best.evaluations >= options.restart_budget) return;
    GaOptions anew = options;
    anew.seed = RandomStream(options.seed, k_restart_stage, item, static_cast<std::uint64_t>(restart)).next();
    Evolution other = nothing_yet();
    climb(table, {}, anew, item, run, other);
    improve(best, other);
  }
}

bool is_solid(const CsgTree& tree) {
  return !primitives_of(simplify(tree)).empty();
}

/// A formula such as a - a scores on a sheet seen from both sides. Replaces it by the best primitive or complement.
void settle_for_a_solid(const RankClasses& table, Evolution& best) {
  if (is_solid(best.tree)) return;
  RankScratch scratch;
  best.score = -std::numeric_limits<double>::infinity();
  for (PrimitiveIndex p = 0; p < table.primitive_count(); ++p) {
    for (CsgTree& tree : std::vector{CsgTree::leaf(p), complement(CsgTree::leaf(p))}) {
      const double score = table.score(tree, scratch);
      if (score <= best.score) continue;
      best.score = score;
      best.geometry = table.geometry(tree, scratch);
      best.tree = std::move(tree);
    }
  }
}

}  // namespace

std::optional<OptionConflict> conflict_in(const GaOptions& options) {
  if (options.elites < options.population) return std::nullopt;
  return OptionConflict{"elites", "expected fewer than the population (" + std::to_string(options.population) +
                                      "), found " + std::to_string(options.elites)};
}

GaOptions paper_ga_options() {
  GaOptions options;
  options.idle_generations = 10;
  options.listing_limit = 2;
  options.trust = 0;
  options.restarts = 0;
  options.seeds = false;
  options.polish = false;
  return options;
}

std::uint64_t partition_item(std::span<const PrimitiveIndex> primitives) {
  std::uint64_t item = 0;
  for (const PrimitiveIndex p : primitives) item = RandomStream(item, p).next();
  return item;
}

Evolution evolve_tree(const RankClasses& table, const GaOptions& options, std::uint64_t item, const RunContext& run) {
  Evolution best = nothing_yet();
  std::vector<CsgTree> seeds;
  if (table.primitive_count() <= options.listing_limit) {
    const Listing listing = list_trees(table, run.stop);
    RankScratch scratch;
    best.tree = listing.best.tree;
    best.score = listing.best.score;
    best.geometry = table.geometry(best.tree, scratch);
    best.evaluations = listing.evaluations;
    best.complete = listing.complete;
    if (is_believed(best, table, options)) return best;
    seeds.push_back(best.tree);
  }
  if (options.seeds) {
    improve(best, seed_by_local_search(table, run, seeds));
    if (is_believed_everywhere(best, table, options) && is_solid(best.tree)) return best;
  }
  search(table, std::move(seeds), options, item, run, best);
  settle_for_a_solid(table, best);
  return best;
}

Evolution evolve_tree_from(const RankClasses& table, const CsgTree& start, const GaOptions& options, std::uint64_t item,
                           const RunContext& run) {
  if (!is_solid(start)) return evolve_tree(table, options, item, run);
  // Without polish the start is only evaluated.
  const LocalSearchOptions climb{.evaluation_limit = options.polish ? LocalSearchOptions{}.evaluation_limit : 0};
  Evolution best = local_search(table, start, climb, run);
  search(table, {start, best.tree}, options, item, run, best);
  settle_for_a_solid(table, best);
  return best;
}

CsgTree evolve_tree(const PointCloud& cloud, const PrimitiveSet& primitives, const Clique& clique,
                    const GaOptions& options, const RunContext& run) {
  const double noise = estimate_noise(cloud, primitives, SegmentationOptions{}.angle_tolerance_deg, run);
  const std::vector<RankClassesRequest> requests{{.primitives = clique}};
  const PointPass pass = build_rank_classes(cloud, primitives, requests,
                                            {.tolerances = segmentation_tolerances({}, noise), .noise = noise}, run);
  const RankClasses& table = pass.tables.front();
  oneapi::tbb::task_arena arena(usable_threads(run));
  const Evolution found = arena.execute([&] { return evolve_tree(table, options, partition_item(clique), run); });
  return simplify(renumber(found.tree, table.primitives()));
}

Evolution local_search(const RankClasses& table, const CsgTree& start, const LocalSearchOptions& options,
                       const RunContext& run) {
  const TreeObjective objective = objective_on(table);
  const LocalOptimum best = local_search(objective, start, options, run);
  return {.tree = best.tree,
          .score = best.score,
          .geometry = objective.geometry(best.tree),
          .evaluations = best.evaluations,
          .complete = best.complete};
}

}  // namespace cloud2csg
