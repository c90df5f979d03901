#include "paper/objective/rank_classes_builder.hpp"

#include <algorithm>
#include <cstdlib>

#include "paper/objective/rank_kernels.hpp"
#include "paper/objective/select_kernels.hpp"

namespace cloud2csg {

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
      // Signed numbers are converted at once.
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
