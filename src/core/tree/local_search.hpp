#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#include "cloud2csg/advanced/local_search.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

struct ScoredTree {
  CsgTree tree;
  double score = 0;
};

struct TreeObjective {
  std::size_t primitives = 0;  ///< trees are over 0 .. primitives - 1
  /// The score without the cost of nodes. Each thread calls a copy of its own, which may hold scratch memory.
  std::function<double(const CsgTree&)> geometry;
  double alpha = 0;  ///< cost of a node
  /// Work of an evaluation, for limits: a part for every tree and a part for each node.
  double work = 0, work_per_node = 1;
};

/// Evaluates trees on a TreeObjective and counts evaluations and work. Each thread needs its own.
class TreeEvaluator {
 public:
  explicit TreeEvaluator(TreeObjective objective) : objective_(std::move(objective)) {}

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
  TreeObjective objective_;
  std::size_t evaluations_ = 0;
  double work_ = 0;
};

struct LocalOptimum : ScoredTree {
  std::size_t evaluations = 0;
  bool complete = true;  ///< false when it was stopped early, with the best tree so far
};

/// Climbs from `start` by the best of all small changes until none improves the score: a node becomes its child, a leaf
/// or another operation; a leaf is put in anywhere. Work counts in the objective's units. Deterministic.
[[nodiscard]] LocalOptimum local_search(const TreeObjective& objective, const CsgTree& start,
                                        const LocalSearchOptions& options, const RunContext& run);

}  // namespace cloud2csg
