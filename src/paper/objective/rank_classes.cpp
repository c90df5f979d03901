#include "cloud2csg/advanced/rank_classes.hpp"

#include <algorithm>
#include <cassert>
#include <cstdlib>

#include "paper/objective/rank_classes.hpp"
#include "paper/objective/rank_kernels.hpp"
#include "paper/objective/select_kernels.hpp"

namespace cloud2csg {
namespace {

template <class Rank>
RankTable<Rank> table_of(const AlignedVector<Rank>& ranks, const AlignedVector<float>& scores, std::size_t primitives,
                         std::size_t padded) {
  return {.ranks = ranks.data(), .scores = scores.data(), .primitives = primitives, .padded = padded};
}

/// Empty and full trees have no surface: they score nothing at any point.
bool has_no_surface(const CsgTree& tree) {
  assert(is_constant(tree) || std::ranges::none_of(tree.nodes(), [](const CsgNode& node) {
           return node.is_leaf() && node.operation() != Operation::primitive;
         }));
  return is_constant(tree);
}

}  // namespace

double RankClasses::geometry(const CsgTree& tree, RankScratch& scratch) const {
  if (has_no_surface(tree)) return 0;
  return std::visit(
      [&](const auto& ranks) {
        return tree_geometry(table_of(ranks, scores_, primitive_count(), padded_count_), tree.nodes(), scratch);
      },
      ranks_);
}

std::vector<float> RankClasses::class_scores(const CsgTree& tree, RankScratch& scratch) const {
  std::vector<float> scores(class_count_);
  if (has_no_surface(tree)) return scores;
  std::visit(
      [&](const auto& ranks) {
        tree_class_scores(table_of(ranks, scores_, primitive_count(), padded_count_), tree.nodes(), scratch, scores);
      },
      ranks_);
  return scores;
}

std::vector<double> RankClasses::sums_by_nearest(std::span<const float> values) const {
  assert(values.size() == class_count_);
  std::vector<double> sums(primitive_count(), 0.0);
  for (std::size_t c = 0; c < class_count_; ++c) sums[nearest_[c]] += static_cast<double>(values[c]);
  return sums;
}

double RankClasses::reference_geometry(const CsgTree& tree) const {
  if (has_no_surface(tree)) return 0;
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

template <class Rank>
void RankClassesBuilder::fill(RankClasses& result, AlignedVector<Rank>& ranks, const ClassTable& classes) {
  const std::size_t n = result.primitive_count();
  const KeyLayout layout(n);
  std::vector<KeyLayout::Place> places;
  places.reserve(n);
  for (std::size_t p = 0; p < n; ++p) places.push_back(layout.place_of(p));
  ranks.assign(n * result.padded_count_, Rank{0});
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const std::span<const std::uint32_t> key = classes.key(c);
    float* const scores = &result.scores_[c * (2 * n + 1)];
    std::int64_t bound = 0;
    for (std::size_t p = 0; p < n; ++p) {
      const std::size_t code = places[p].code_in(key);
      const int rank = static_cast<int>(code) - static_cast<int>(n);
      ranks[p * result.padded_count_ + c] = static_cast<Rank>(rank);
      const WideContribution sum = classes.sum(c, p);
      // Signed numbers convert in one step.
      const auto plain = static_cast<std::int64_t>(sum.plain);
      const auto complement = static_cast<std::int64_t>(sum.complement);
      scores[code] = static_cast<float>(static_cast<double>(plain) * k_unit);
      scores[2 * n - code] = static_cast<float>(static_cast<double>(complement) * k_unit);
      bound = std::max({bound, plain, complement});
      if (std::abs(rank) == 1) result.nearest_[c] = static_cast<std::uint16_t>(p);
    }
    result.bounds_[c] = static_cast<float>(static_cast<double>(bound) * k_unit);
    result.geometry_bound_ += static_cast<double>(result.bounds_[c]);
  }
}

RankClasses RankClassesBuilder::build(std::span<const PrimitiveIndex> primitives, const ClassTable& classes,
                                      const Objective& objective) {
  RankClasses result;
  result.primitives_.assign(primitives.begin(), primitives.end());
  result.point_count_ = classes.point_count();
  result.class_count_ = classes.size();
  result.padded_count_ =
      std::max<std::size_t>((classes.size() + k_class_padding - 1) / k_class_padding, 1) * k_class_padding;
  result.objective_ = objective;
  result.scores_.assign(result.padded_count_ * (2 * primitives.size() + 1), 0.0F);
  result.nearest_.assign(classes.size(), 0);
  result.bounds_.resize(classes.size());
  if (primitives.size() <= RankClasses::k_byte_limit) {
    fill(result, result.ranks_.emplace<AlignedVector<std::int8_t>>(), classes);
  } else {
    fill(result, result.ranks_.emplace<AlignedVector<std::int16_t>>(), classes);
  }
  return result;
}

}  // namespace cloud2csg
