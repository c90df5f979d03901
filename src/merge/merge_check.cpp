#include "merge/merge_check.hpp"

#include <algorithm>
#include <cassert>

namespace cloud2csg {
namespace {

/// Scores of classes summed by the nearest primitive.
std::vector<double> by_nearest(const RankClasses& table, std::span<const float> class_scores) {
  std::vector<double> sums(table.primitive_count(), 0.0);
  const std::span<const std::uint16_t> nearest = table.nearest_primitive();
  for (std::size_t c = 0; c < class_scores.size(); ++c) sums[nearest[c]] += static_cast<double>(class_scores[c]);
  return sums;
}

}  // namespace

MergeCheck::MergeCheck(const RankClasses& table, std::span<const Clique> cliques, std::span<const CsgTree> trees)
    : table_(table), promised_(table.primitive_count(), 0.0) {
  assert(cliques.size() == trees.size());
  RankScratch scratch;
  for (std::size_t k = 0; k < trees.size(); ++k) {
    const std::vector<double> reached = by_nearest(table, table.class_scores(trees[k], scratch));
    for (const PrimitiveIndex p : cliques[k]) promised_[p] = std::max(promised_[p], reached[p]);
  }
}

double MergeCheck::worst_shortfall(const CsgTree& merged) const {
  RankScratch scratch;
  const std::vector<double> reached = by_nearest(table_, table_.class_scores(merged, scratch));
  // What less than one node's worth of points say is noise.
  const double slack = table_.objective().alpha;
  double worst = 0;
  for (std::size_t p = 0; p < promised_.size(); ++p) {
    const double missing = promised_[p] - reached[p];
    if (missing > slack) worst = std::max(worst, missing / promised_[p]);
  }
  return worst;
}

}  // namespace cloud2csg
