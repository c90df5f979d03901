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

/// Evaluates trees on a table and counts evaluations. Each thread needs its own.
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
  /// Sum of classes x nodes over the evaluations.
  [[nodiscard]] double work() const { return work_; }
  [[nodiscard]] std::size_t primitives() const { return table_.primitive_count(); }

 private:
  const RankClasses& table_;
  RankScratch scratch_;
  std::size_t evaluations_ = 0;
  double work_ = 0;
};

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

/// Runs the genetic algorithm on a table, or on any objective. `seeds` join the first generation.
[[nodiscard]] Evolution run_genetic_algorithm(const RankClasses& table, std::span<const CsgTree> seeds,
                                              const GaOptions& options, std::uint64_t item, const RunContext& run);

[[nodiscard]] Evolution run_genetic_algorithm(const TreeObjective& objective, std::span<const CsgTree> seeds,
                                              const GaOptions& options, std::uint64_t item, const RunContext& run);

}  // namespace cloud2csg
