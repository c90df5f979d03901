#pragma once

#include <cstddef>
#include <functional>

#include "cloud2csg/advanced/local_search.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// A tree with its score by the objective that is searched.
struct ScoredTree {
  CsgTree tree;
  double score = 0;
};

/// What makes one tree better than another.
struct TreeObjective {
  std::size_t primitives = 0;  ///< trees are over 0 .. primitives - 1
  /// The score without the cost of size. A genetic algorithm calls it on several threads at a time.
  std::function<double(const CsgTree&)> geometry;
  double alpha = 0;  ///< cost of a node
  /// Of an evaluation, for limits: a part that is the same for all trees, and a part a node.
  double work = 0, work_per_node = 1;
};

/// Evaluates trees on a TreeObjective and counts how many; one a thread.
class ObjectiveEvaluator {
 public:
  explicit ObjectiveEvaluator(const TreeObjective& objective) : objective_(objective) {}

  [[nodiscard]] double score(const CsgTree& tree) {
    ++evaluations_;
    work_ += objective_.work + objective_.work_per_node * static_cast<double>(tree.size());
    return geometry(tree) - objective_.alpha * static_cast<double>(tree.size());
  }
  [[nodiscard]] double geometry(const CsgTree& tree) const { return objective_.geometry(tree); }
  [[nodiscard]] std::size_t evaluations() const { return evaluations_; }
  [[nodiscard]] double work() const { return work_; }
  [[nodiscard]] std::size_t primitives() const { return objective_.primitives; }

 private:
  const TreeObjective& objective_;
  std::size_t evaluations_ = 0;
  double work_ = 0;
};

struct LocalOptimum : ScoredTree {
  std::size_t evaluations = 0;
  bool complete = true;  ///< false when it was stopped early: the best tree so far
};

/// Climbs from `start` by the best of all small changes (a node replaced by its child, by a leaf, by another operation;
/// a leaf put in anywhere) until none improves the score. The limit of work is in the objective's terms. Deterministic.
[[nodiscard]] LocalOptimum local_search(const TreeObjective& objective, const CsgTree& start,
                                        const LocalSearchOptions& options, const RunContext& run);

}  // namespace cloud2csg
