#include "paper/objective/rank_kernels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "paper/objective/rank_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#ifndef CLOUD2CSG_FITNESS_STANDINGS
#define CLOUD2CSG_FITNESS_STANDINGS
namespace cloud2csg {

/// How the primitives of a block rank. Unless their ranges overlap, one of two is nearer at every point.
template <class Real>
class Standings {
 public:
  explicit Standings(std::span<const DistanceColumn<Real>> primitives)
      : rivals_(primitives.size() * primitives.size()), counts_(primitives.size()) {
    for (std::size_t q = 1; q < primitives.size(); ++q) {
      for (std::size_t p = 0; p < q; ++p) {
        if (primitives[p].largest < primitives[q].smallest) {
          ++counts_[q].always_nearer;
        } else if (primitives[q].largest < primitives[p].smallest) {
          ++counts_[p].always_nearer;
        } else {
          row(q)[counts_[q].earlier++] = primitives[p].distances;
          row(p)[counts_.size() - ++counts_[p].later] = primitives[q].distances;
        }
      }
    }
  }

  /// One more than the number of primitives that are nearer at every point.
  [[nodiscard]] int certain_rank(std::size_t p) const { return 1 + counts_[p].always_nearer; }
  /// Distances of the primitives of smaller, and of larger index that are sometimes nearer.
  [[nodiscard]] std::span<const Real* const> earlier(std::size_t p) const { return row(p).first(counts_[p].earlier); }
  [[nodiscard]] std::span<const Real* const> later(std::size_t p) const { return row(p).last(counts_[p].later); }

 private:
  struct Counts {
    int always_nearer = 0;
    std::uint32_t earlier = 0, later = 0;
  };
  [[nodiscard]] std::span<const Real*> row(std::size_t p) {
    return std::span(rivals_).subspan(p * counts_.size(), counts_.size());
  }
  [[nodiscard]] std::span<const Real* const> row(std::size_t p) const {
    return std::span(rivals_).subspan(p * counts_.size(), counts_.size());
  }

  std::vector<const Real*> rivals_;  // by primitive: the earlier ones from the front, the later ones from the back
  std::vector<Counts> counts_;
};

}  // namespace cloud2csg
#endif

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using Bytes = hn::ScalableTag<std::int8_t>;
using Words = hn::ScalableTag<std::uint32_t>;

/// Ranks are counted in the type of the distances, and narrowed at the end.
HWY_INLINE void store_narrowed(hn::ScalableTag<float> d, hn::Vec<hn::ScalableTag<float>> ranks, std::int8_t* out) {
  const hn::RebindToSigned<decltype(d)> di;
  hn::StoreU(hn::DemoteTo(hn::Rebind<std::int8_t, decltype(d)>(), hn::ConvertTo(di, ranks)),
             hn::Rebind<std::int8_t, decltype(d)>(), out);
}
HWY_INLINE void store_narrowed(hn::ScalableTag<double> d, hn::Vec<hn::ScalableTag<double>> ranks, std::int8_t* out) {
  const hn::Rebind<std::int32_t, decltype(d)> di;
  hn::StoreU(hn::DemoteTo(hn::Rebind<std::int8_t, decltype(d)>(), hn::DemoteTo(di, ranks)),
             hn::Rebind<std::int8_t, decltype(d)>(), out);
}

template <class Real>
void rank_one(const Real* distances, const Standings<Real>& standings, std::size_t p, RankColumn& out) {
  const hn::ScalableTag<Real> d;
  const auto one = hn::Set(d, Real{1});
  const auto certain_rank = hn::Set(d, static_cast<Real>(standings.certain_rank(p)));
  for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
    const auto distance = hn::Load(d, distances + i);
    const auto magnitude = hn::Abs(distance);
    auto rank = certain_rank;
    // Ties go by index: among equal magnitudes, a smaller index comes before.
    for (const Real* other : standings.earlier(p)) {
      rank = rank + hn::IfThenElseZero(hn::Abs(hn::Load(d, other + i)) <= magnitude, one);
    }
    for (const Real* other : standings.later(p)) {
      rank = rank + hn::IfThenElseZero(hn::Abs(hn::Load(d, other + i)) < magnitude, one);
    }
    store_narrowed(d, hn::IfThenElse(distance < hn::Zero(d), hn::Neg(rank), rank), &out.ranks[i]);
  }
}

template <class Real>
void rank_all(std::span<const DistanceColumn<Real>> primitives, std::span<RankColumn> out) {
  const Standings<Real> standings(primitives);
  for (std::size_t p = 0; p < primitives.size(); ++p) rank_one(primitives[p].distances, standings, p, out[p]);
}

void rank_doubles(std::span<const DistanceColumn<double>> primitives, std::span<RankColumn> out) {
  rank_all(primitives, out);
}
void rank_floats(std::span<const DistanceColumn<float>> primitives, std::span<RankColumn> out) {
  rank_all(primitives, out);
}

void rank_among_fewer(std::span<const RankColumn* const> primitives, std::span<RankColumn> out) {
  const Bytes d;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
      const auto old = hn::Load(d, &primitives[p]->ranks[i]);
      const auto magnitude = hn::Abs(old);
      auto rank = hn::Set(d, std::int8_t{1});
      for (const RankColumn* other : primitives) {  // itself does not count: it is not smaller
        const auto before = hn::Abs(hn::Load(d, &other->ranks[i])) < magnitude;
        rank = rank - hn::VecFromMask(d, before);  // a true mask is -1
      }
      hn::Store(hn::IfThenElse(old < hn::Zero(d), hn::Neg(rank), rank), d, &out[p].ranks[i]);
    }
  }
}

void pack_ranks(std::span<const RankColumn> columns, const KeyLayout& layout, BlockKeys& keys) {
  const Words d;
  const hn::RebindToSigned<Words> di;
  const hn::Rebind<std::int8_t, Words> narrow;
  const auto zero_rank = hn::Set(di, static_cast<std::int32_t>(columns.size()));
  for (std::size_t w = 0; w < layout.words; ++w) {
    const std::size_t first = w * layout.codes_per_word;
    const std::size_t last = std::min(first + layout.codes_per_word, columns.size());
    for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
      auto word = hn::Zero(d);
      for (std::size_t p = first; p < last; ++p) {
        const auto code = hn::PromoteTo(di, hn::LoadU(narrow, &columns[p].ranks[i])) + zero_rank;
        word = hn::Or(word, hn::ShiftLeftSame(hn::BitCast(d, code), static_cast<int>(layout.shift_of(p))));
      }
      hn::Store(word, d, &keys.words[w * k_block_points + i]);
    }
  }
}

void pack_members(std::span<const BlockMask* const> members, BlockKeys& keys) {
  const Words d;
  std::uint32_t* const word = &keys.words[(keys.count - 1) * k_block_points];
  for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
    auto bits = hn::Zero(d);
    for (std::size_t k = 0; k < members.size(); ++k) {
      const std::uint64_t rest = (*members[k])[i / 64] >> (i % 64);
      std::array<std::uint8_t, sizeof rest> bytes{};
      std::memcpy(bytes.data(), &rest, sizeof rest);
      const auto is_member = hn::LoadMaskBits(d, bytes.data());
      bits = hn::Or(bits, hn::IfThenElseZero(is_member, hn::Set(d, std::uint32_t{1} << k)));
    }
    hn::Store(bits, d, word + i);
  }
}

/// Multiplies by odd numbers and shifts, so that every bit of every word counts.
void hash_keys(BlockKeys& keys) {
  const Words d;
  const auto multiplier = hn::Set(d, 0x9e3779b1U);
  for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
    auto hash = hn::Zero(d);
    for (std::size_t w = 0; w < keys.count; ++w) {
      hash = hn::Xor(hash, hn::Load(d, &keys.words[w * k_block_points + i])) * multiplier;
      hash = hn::Xor(hash, hn::ShiftRight<15>(hash));
    }
    hn::Store(hash, d, &keys.hashes[i]);
  }
}

}  // namespace
}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cloud2csg {

HWY_EXPORT(rank_doubles);
HWY_EXPORT(rank_floats);
HWY_EXPORT(rank_among_fewer);
HWY_EXPORT(pack_ranks);
HWY_EXPORT(pack_members);
HWY_EXPORT(hash_keys);

void compute_signed_ranks(std::span<const DistanceColumn<double>> primitives, std::span<RankColumn> out) {
  HWY_DYNAMIC_DISPATCH(rank_doubles)(primitives, out);
}
void compute_signed_ranks(std::span<const DistanceColumn<float>> primitives, std::span<RankColumn> out) {
  HWY_DYNAMIC_DISPATCH(rank_floats)(primitives, out);
}
void compute_signed_ranks(std::span<const RankColumn* const> primitives, std::span<RankColumn> out) {
  HWY_DYNAMIC_DISPATCH(rank_among_fewer)(primitives, out);
}

KeyLayout::KeyLayout(std::size_t primitives)
    : bits(static_cast<std::uint32_t>(std::bit_width(2 * primitives))),
      codes_per_word(32 / bits),
      words((primitives + codes_per_word - 1) / codes_per_word) {}

void pack_rank_keys(std::span<const RankColumn> columns, const KeyLayout& layout, BlockKeys& keys) {
  HWY_DYNAMIC_DISPATCH(pack_ranks)(columns, layout, keys);
}
void pack_member_word(std::span<const BlockMask* const> members, BlockKeys& keys) {
  HWY_DYNAMIC_DISPATCH(pack_members)(members, keys);
}
void compute_hashes(BlockKeys& keys) {
  HWY_DYNAMIC_DISPATCH(hash_keys)(keys);
}

namespace {

template <class Real>
void sort_keys(std::span<const Real* const> distances, const KeyLayout& layout, BlockKeys& keys) {
  const std::size_t n = distances.size();
  std::fill_n(keys.words.begin(), layout.words * k_block_points, 0U);
  std::vector<std::uint32_t> order(n);
  for (std::size_t i = 0; i < k_block_points; ++i) {
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
      const Real x = std::abs(distances[a][i]);
      const Real y = std::abs(distances[b][i]);
      return x != y ? x < y : a < b;
    });
    for (std::size_t rank = 1; rank <= n; ++rank) {
      const std::uint32_t p = order[rank - 1];
      const auto code = static_cast<std::uint32_t>(distances[p][i] < 0 ? n - rank : n + rank);
      keys.words[layout.word_of(p) * k_block_points + i] |= code << layout.shift_of(p);
    }
  }
}

}  // namespace

void sort_rank_keys(std::span<const double* const> distances, const KeyLayout& layout, BlockKeys& keys) {
  sort_keys(distances, layout, keys);
}
void sort_rank_keys(std::span<const float* const> distances, const KeyLayout& layout, BlockKeys& keys) {
  sort_keys(distances, layout, keys);
}

}  // namespace cloud2csg
#endif  // HWY_ONCE
