#include "cloud2csg/rank_classes.hpp"

#include <algorithm>
#include <cassert>

#include "fitness/select_kernels.hpp"

namespace cloud2csg {
namespace {

template <class Rank>
RankTable<Rank> table_of(const AlignedVector<Rank>& ranks, const AlignedVector<float>& scores, std::size_t primitives,
                         std::size_t padded) {
  return {.ranks = ranks.data(), .scores = scores.data(), .primitives = primitives, .padded = padded};
}

/// Whether the tree is nothing or all of space: without a surface, it scores nothing at any point.
bool is_constant(const CsgTree& tree) {
  const auto is_constant_node = [](const CsgNode& node) {
    return node.operation() == Operation::empty || node.operation() == Operation::full;
  };
  assert(tree.size() == 1 || std::ranges::none_of(tree.nodes(), is_constant_node));
  return is_constant_node(tree.nodes().front()) && tree.size() == 1;
}

}  // namespace

double RankClasses::geometry(const CsgTree& tree, RankScratch& scratch) const {
  if (is_constant(tree)) return 0;
  return std::visit(
      [&](const auto& ranks) {
        return tree_geometry(table_of(ranks, scores_, primitive_count(), padded_count_), tree.nodes(), scratch);
      },
      ranks_);
}

std::vector<float> RankClasses::class_scores(const CsgTree& tree, RankScratch& scratch) const {
  std::vector<float> scores(class_count_);
  if (is_constant(tree)) return scores;
  std::visit(
      [&](const auto& ranks) {
        tree_class_scores(table_of(ranks, scores_, primitive_count(), padded_count_), tree.nodes(), scratch, scores);
      },
      ranks_);
  return scores;
}

std::vector<float> RankClasses::class_bounds() const {
  std::vector<float> bounds(class_count_);
  const auto row = static_cast<std::ptrdiff_t>(2 * primitive_count() + 1);
  auto scores = scores_.begin();
  for (float& bound : bounds) {
    bound = *std::max_element(scores, scores + row);
    scores += row;
  }
  return bounds;
}

std::vector<double> RankClasses::sums_by_nearest(std::span<const float> values) const {
  assert(values.size() == class_count_);
  std::vector<double> sums(primitive_count(), 0.0);
  for (std::size_t c = 0; c < class_count_; ++c) sums[nearest_[c]] += static_cast<double>(values[c]);
  return sums;
}

double RankClasses::reference_geometry(const CsgTree& tree) const {
  if (is_constant(tree)) return 0;
  double sum = 0;
  const std::size_t row = 2 * primitive_count() + 1;
  std::visit(
      [&](const auto& ranks) {
        const auto table = table_of(ranks, scores_, primitive_count(), padded_count_);
        for (std::size_t c = 0; c < class_count_; ++c) {
          const int rank = select_rank(table, tree.nodes(), c);
          sum += static_cast<double>(
              scores_[c * row + static_cast<std::size_t>(static_cast<int>(primitive_count()) + rank)]);
        }
      },
      ranks_);
  return sum;
}

std::span<const std::int8_t> RankClasses::column(PrimitiveIndex local) const {
  assert(primitive_count() <= k_byte_limit);
  return std::span(std::get<AlignedVector<std::int8_t>>(ranks_)).subspan(local * padded_count_, padded_count_);
}

RankClasses::ColumnGeometry RankClasses::column_geometry(std::span<const std::int8_t> column) const {
  return cloud2csg::column_geometry(
      table_of(std::get<AlignedVector<std::int8_t>>(ranks_), scores_, primitive_count(), padded_count_), column);
}

void RankClasses::combine(Operation operation, std::span<const std::int8_t> a, std::span<const std::int8_t> b,
                          std::span<std::int8_t> out) {
  combine_columns(operation, a, b, out);
}

}  // namespace cloud2csg
