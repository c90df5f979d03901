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
    : table_(table) {
  assert(cliques.size() == trees.size());
  RankScratch scratch;
  std::vector<float> promise(table.class_count(), 0.0F);
  const std::span<const std::uint16_t> nearest = table.nearest_primitive();
  for (std::size_t k = 0; k < trees.size(); ++k) {
    std::vector<char> knows(table.primitive_count(), 0);
    for (const PrimitiveIndex p : cliques[k]) knows[p] = 1;
    const std::vector<float> scores = table.class_scores(trees[k], scratch);
    for (std::size_t c = 0; c < promise.size(); ++c) {
      if (knows[nearest[c]] != 0) promise[c] = std::max(promise[c], scores[c]);
    }
  }
  promised_ = by_nearest(table, promise);
}

double MergeCheck::worst_shortfall(const CsgTree& merged) const {
  RankScratch scratch;
  const std::vector<double> reached = by_nearest(table_, table_.class_scores(merged, scratch));
  // What less than one node's worth of points say is noise.
  const double least = table_.objective().alpha;
  double worst = 0;
  for (std::size_t p = 0; p < promised_.size(); ++p) {
    if (promised_[p] > least) worst = std::max(worst, (promised_[p] - reached[p]) / promised_[p]);
  }
  return worst;
}

}  // namespace cloud2csg
