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
  int population = 150;         ///< trees a generation (paper)
  int elites = 2;               ///< best trees that go to the next generation unchanged (paper)
  int tournament = 2;           ///< a parent is the best of so many drawn at random (paper)
  double crossover_rate = 0.3;  ///< chance that two parents swap random subtrees (paper)
  double mutation_rate = 0.3;   ///< chance that a child is mutated (paper)
  double new_tree_rate =
      0.5;  ///< of the mutations: the whole tree is replaced by a new one, else a random subtree (paper)
  /// Edges on the longest path of a tree. Absent: sqrt(pi / 2 * n (n - 1)) for n primitives (paper).
  std::optional<int> height_limit = {};
  /// Stop when the best score has not improved for so many generations. The paper stops after 10, and then misses the
  /// true solid in some runs (bench/recovery counts them).
  int idle_generations = 40;
  int generation_limit = 10'000;  ///< stop here in any case

  // Beyond the paper. bench/recovery measures each alone.

  /// Partitions of up to so many primitives are solved by listing all trees that use each primitive at most once; the
  /// paper lists up to 2. Each one more is about 20 times the work; at most 5.
  std::size_t listing_limit = 4;
  /// A tree is believed when it reaches this share of what no tree can exceed (RankClasses::geometry_bound). Where a
  /// listed tree does not, the genetic algorithm looks for one that uses a primitive more than once; where its tree
  /// does not either, it is run anew; where a local search's does on the points nearest to each primitive, it is not
  /// run at all. 0: every listed tree is believed, and of larger partitions none before the algorithm has run (paper).
  double trust = 0.97;
  /// New runs from other random trees, at most, while the best tree is not believed ...
  int restarts = 3;
  /// ... and no more than so many trees were evaluated for the partition.
  std::size_t restart_budget = 200'000;
  bool seeds = true;  ///< the first generation also has the results of local searches from simple trees
  /// A local search on the best tree at the end; when it finds a better one, the algorithm goes on.
  bool polish = true;

  std::uint64_t seed = 1;
};

/// The parameters of the paper, nothing added.
[[nodiscard]] GaOptions paper_ga_options();

/// The tree found for one set of primitives, and what it took.
struct Evolution {
  CsgTree tree;         ///< over the table's local indices
  double score = 0;     ///< E(t)
  double geometry = 0;  ///< E(t) without the cost of size
  std::size_t generations = 0;
  std::size_t evaluations = 0;
  bool complete = true;  ///< false when it was stopped early: the best tree so far
};

/// Height limit of the paper for n primitives; at least 1.
[[nodiscard]] inline int default_height_limit(std::size_t primitives) {
  const auto n = static_cast<double>(primitives);
  return std::max(1, static_cast<int>(std::sqrt(std::numbers::pi / 2 * n * (n - 1))));
}

/// The name of a partition's random stream: the same for the same primitives, whoever searches.
[[nodiscard]] std::uint64_t partition_item(std::span<const PrimitiveIndex> primitives);

/// Searches for the tree with the highest E(t). `item` tells partitions apart: each has a random stream of its own.
/// The result depends on the table, the options and `item` only, not on threads. With run.threads == 1 there is one,
/// else the population is spread over those of the task arena that the caller is in, so that searches may be run side
/// by side. Stops between generations when run.stop is triggered. Precondition: the table has at least one primitive.
[[nodiscard]] Evolution evolve_tree(const RankClasses& table, const GaOptions& options, std::uint64_t item,
                                    const RunContext& run = {});

/// The same with a tree to start from (over local indices), e.g. one that is nearly right.
[[nodiscard]] Evolution evolve_tree_from(const RankClasses& table, const CsgTree& start, const GaOptions& options,
                                         std::uint64_t item, const RunContext& run = {});

/// The sentence of the paper in one call: the tree for one clique of primitives, over the whole set's indices, from the
/// points that belong to them.
[[nodiscard]] CsgTree evolve_tree(const PointCloud& cloud, const PrimitiveSet& primitives, const Clique& clique,
                                  const GaOptions& options = {}, const RunContext& run = {});

/// Climbs from `start` by the best of all small changes (a node replaced by its child, by a leaf, by another operation;
/// a leaf put in anywhere) until none improves E(t). Deterministic.
[[nodiscard]] Evolution local_search(const RankClasses& table, const CsgTree& start,
                                     const LocalSearchOptions& options = {}, const RunContext& run = {});

}  // namespace cloud2csg
