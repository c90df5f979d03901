#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "cloud2csg/advanced/local_search.hpp"
#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/advanced/rank_classes.hpp"

/// The search for the tree of one partition (section 4.3 of the paper).
namespace cloud2csg {

struct GaOptions {
  int population = 150, elites = 2, tournament = 2;
  double crossover_rate = 0.3, mutation_rate = 0.3, new_tree_rate = 0.5;
  std::optional<int> height_limit = {};
  int idle_generations = 40, generation_limit = 10'000;
  // Beyond the paper; bench/recovery measures the effect of each.
  std::size_t listing_limit = 4;
  double trust = 0.97;
  int restarts = 3;
  std::size_t restart_budget = 200'000;
  bool seeds = true, polish = true;
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<GaOptions>, auto&& field) {
  using O = GaOptions;
  field(&O::population, "population", "Number of trees in a generation", at_least(2));
  field(&O::elites, "elites", "Number of best trees that pass to the next generation unchanged", at_least(0));
  field(&O::tournament, "tournament", "Number of trees drawn at random for each parent, of which the best is taken",
        at_least(1));
  field(&O::crossover_rate, "crossover_rate", "Probability that two parents swap random subtrees", k_share,
        {.unit = "P"});
  field(&O::mutation_rate, "mutation_rate", "Probability that a child is mutated", k_share, {.unit = "P"});
  field(&O::new_tree_rate, "new_tree_rate",
        "Share of mutations that replace the whole tree instead of a random subtree", k_share, {.unit = "SHARE"});
  field(&O::height_limit, "height_limit", "Largest height of a tree: edges on its longest path", at_least(1),
        {.absent = "sqrt(pi / 2 * n (n - 1)) for n primitives"});
  field(&O::idle_generations, "idle_generations",
        "Stop when the best score has not improved for this many generations. The paper stops after 10, and then "
        "misses the true solid in some runs (bench/recovery counts them).",
        at_least(1));
  field(&O::generation_limit, "generation_limit", "Stop after this many generations in any case", at_least(1));
  field(&O::listing_limit, "listing_limit",
        "Solve partitions of up to this many primitives by listing all trees that use each primitive at most once. The "
        "paper lists up to 2. Each additional primitive takes about 20 times the work; at most 5.",
        from_to(0, 5));
  field(&O::trust, "trust",
        "Search again if a tree reaches less than this share of the upper bound of the score. If a listed tree falls "
        "short, the genetic algorithm looks for one that uses a primitive more than once; if its tree falls short too, "
        "it runs again. If the tree of a local search does not fall short on the points nearest to each primitive, the "
        "genetic algorithm does not run. 0: believe every listed tree, and no tree of a larger partition before the "
        "algorithm has run, as in the paper.",
        k_share, {.unit = "SHARE"});
  field(&O::restarts, "restarts", "Largest number of repeated searches, each from other random trees", at_least(0));
  field(&O::restart_budget, "restart_budget",
        "Do not repeat a search once this many trees were evaluated for the partition");
  field(&O::seeds, "seeds", "Add results of local searches from simple trees to the first generation",
        {.option = "seeds", .opposite = "no-seeds", .otherwise = "Use a random first generation"});
  field(&O::polish, "polish", "Improve the best tree at the end by single changes; if that helps, continue from there",
        {.option = "local-search",
         .opposite = "no-local-search",
         .otherwise = "Do not improve the best tree by single changes"});
  field(&O::seed, k_inner_seed);
}
/// Refuses more elites than trees.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const GaOptions& options);

[[nodiscard]] GaOptions paper_ga_options();

/// The tree found for one set of primitives, and the effort.
struct Evolution {
  CsgTree tree;         ///< over the table's local indices
  double score = 0;     ///< E(t)
  double geometry = 0;  ///< E(t) without the cost of size
  std::size_t generations = 0;
  std::size_t evaluations = 0;
  bool complete = true;  ///< false when stopped early with the best tree so far
};

/// The paper's height limit for n primitives; at least 1.
[[nodiscard]] inline int default_height_limit(std::size_t primitives) {
  const auto n = static_cast<double>(primitives);
  return std::max(1, static_cast<int>(std::sqrt(std::numbers::pi / 2 * n * (n - 1))));
}

/// The random stream of a partition: equal for equal primitives.
[[nodiscard]] std::uint64_t partition_item(std::span<const PrimitiveIndex> primitives);

/// Searches for the tree with the highest E(t). `item` selects the random stream of the partition. The result depends
/// only on the table, the options and `item`, not on threads. With run.threads == 1 the search uses one thread.
/// Otherwise it spreads the population over the caller's task arena, so searches may run side by side. Stops between
/// generations when run.stop is triggered. Precondition: the table has at least one primitive.
[[nodiscard]] Evolution evolve_tree(const RankClasses& table, const GaOptions& options, std::uint64_t item,
                                    const RunContext& run = {});

/// The same from a start tree over local indices, e.g. a nearly correct one.
[[nodiscard]] Evolution evolve_tree_from(const RankClasses& table, const CsgTree& start, const GaOptions& options,
                                         std::uint64_t item, const RunContext& run = {});

/// The paper's step in one call: a clique's tree, over indices of the whole set, from the points on its primitives.
[[nodiscard]] CsgTree evolve_tree(const PointCloud& cloud, const PrimitiveSet& primitives, const Clique& clique,
                                  const GaOptions& options = {}, const RunContext& run = {});

/// Climbs from `start` by the best small change until none improves E(t). Changes replace a node by its child, a leaf
/// or another operation, or insert a leaf anywhere. Deterministic.
[[nodiscard]] Evolution local_search(const RankClasses& table, const CsgTree& start,
                                     const LocalSearchOptions& options = {}, const RunContext& run = {});

}  // namespace cloud2csg
