#pragma once

#include <span>
#include <vector>

#include "cloud2csg/overlap_graph.hpp"
#include "cloud2csg/rank_classes.hpp"

namespace cloud2csg {

/// What partition trees promise on the points of a whole component, and how far a merged tree falls short of it.
///
/// For each primitive, the promise is the best that a partition tree with that primitive reaches on the points nearest
/// to it. It is kept by primitive, so that a small feature that was lost is seen although it weighs little in the
/// whole.
class MergeCheck {
 public:
  /// `cliques` and `trees` belong together; both index the table's primitives locally. O(trees x classes).
  MergeCheck(const RankClasses& table, std::span<const Clique> cliques, std::span<const CsgTree> trees);

  /// The largest share of a primitive's promise that `merged` does not reach; 0 when it reaches all.
  [[nodiscard]] double worst_shortfall(const CsgTree& merged) const;

 private:
  const RankClasses& table_;
  std::vector<double> promised_;  // by primitive
};

}  // namespace cloud2csg
