#pragma once

#include <cstddef>
#include <span>

#include "cloud2csg/advanced/evolve.hpp"
#include "cloud2csg/advanced/rank_classes.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/base/random.hpp"
#include "core/tree/local_search.hpp"

/// The genetic algorithm of the paper, and its operators, crossover and mutation, on flat trees.
namespace cloud2csg {

/// Evaluates trees on a table and counts how many; one a thread.
class Evaluator {
 public:
  explicit Evaluator(const RankClasses& table) : table_(table) {}

  [[nodiscard]] double score(const CsgTree& tree) {
    ++evaluations_;
    work_ += static_cast<double>(table_.class_count()) * static_cast<double>(tree.size());
    return table_.score(tree, scratch_);
  }
  [[nodiscard]] double geometry(const CsgTree& tree) { return table_.geometry(tree, scratch_); }
  [[nodiscard]] std::size_t evaluations() const { return evaluations_; }
  /// Evaluations x classes x nodes.
  [[nodiscard]] double work() const { return work_; }
  [[nodiscard]] std::size_t primitives() const { return table_.primitive_count(); }

 private:
  const RankClasses& table_;
  RankScratch scratch_;
  std::size_t evaluations_ = 0;
  double work_ = 0;
};

/// A random tree over primitives 0 .. count - 1 of at most `height` edges from root to leaf: at each node a leaf or an
/// operation with equal chance, operations with equal chance, down to leaves at the limit.
[[nodiscard]] CsgTree random_tree(std::size_t count, int height, RandomStream& random);

struct Children {
  CsgTree first, second;
};

/// Two children that swapped one random subtree each. A child that would be higher than the limit stays as its own
/// parent was.
[[nodiscard]] Children crossover(const CsgTree& a, const CsgTree& b, int height_limit, RandomStream& random);

/// A tree with one random subtree replaced by a new random tree that keeps the height limit.
[[nodiscard]] CsgTree mutate_subtree(const CsgTree& tree, std::size_t primitives, int height_limit,
                                     RandomStream& random);

/// The genetic algorithm of the paper on one table; `seeds` join the first generation.
[[nodiscard]] Evolution run_genetic_algorithm(const RankClasses& table, std::span<const CsgTree> seeds,
                                              const GaOptions& options, std::uint64_t item, const RunContext& run);

/// The same on any objective.
[[nodiscard]] Evolution run_genetic_algorithm(const TreeObjective& objective, std::span<const CsgTree> seeds,
                                              const GaOptions& options, std::uint64_t item, const RunContext& run);

}  // namespace cloud2csg
