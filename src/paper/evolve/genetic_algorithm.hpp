#pragma once

#include <cstddef>
#include <span>

#include "cloud2csg/advanced/evolve.hpp"
#include "cloud2csg/advanced/rank_classes.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/base/random.hpp"
#include "core/tree/local_search.hpp"

/// The paper's genetic algorithm, with crossover and mutation on flat trees.
namespace cloud2csg {

/// A random tree over primitives 0 .. count - 1, at most `height` edges high. Each node is a leaf or an operation with
/// equal chance, and all operations have equal chance. Nodes at the limit are leaves.
[[nodiscard]] CsgTree random_tree(std::size_t count, int height, RandomStream& random);

struct Children {
  CsgTree first, second;
};

/// Swaps a random subtree of each tree. A child that would be above the height limit stays as its parent was.
[[nodiscard]] Children crossover(const CsgTree& a, const CsgTree& b, int height_limit, RandomStream& random);

/// Replaces a random subtree by a new random tree within the height limit.
[[nodiscard]] CsgTree mutate_subtree(const CsgTree& tree, std::size_t primitives, int height_limit,
                                     RandomStream& random);

/// E(t) by the classes of a table, which must outlive it. The work of an evaluation is classes x nodes.
[[nodiscard]] TreeObjective objective_on(const RankClasses& table);

/// Runs the genetic algorithm. `seeds` join the first generation.
[[nodiscard]] Evolution run_genetic_algorithm(const TreeObjective& objective, std::span<const CsgTree> seeds,
                                              const GaOptions& options, std::uint64_t item, const RunContext& run);

}  // namespace cloud2csg
