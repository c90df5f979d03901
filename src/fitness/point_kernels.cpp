#include "fitness/point_kernels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fitness/point_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using Floats = hn::ScalableTag<float>;
using Doubles = hn::CappedTag<double, 8>;  // at most 8, so that a byte holds the mask of one step

/// Arguments of exp(-t): the distance's part and the angle's part of each point's score, and the side of the normal.
struct Exponents {
  alignas(64) std::array<float, k_block_points> distance, angle_chord, cosine;
};

/// exp(-t) for t >= 0 to about 1e-7 relative, 0 from 87 on: 2^k times a polynomial of degree 6 on |r| <= ln(2) / 2.
template <class V>
HWY_INLINE V exp_negative(V t) {
  const hn::DFromV<V> d;
  const hn::RebindToSigned<decltype(d)> di;
  const V magic = hn::Set(d, 12582912.0F);  // 1.5 * 2^23: adding it rounds to an integer
  const V x = hn::Neg(hn::Min(t, hn::Set(d, 87.0F)));
  const V shifted = x * hn::Set(d, 1.44269504F) + magic;
  const V k = shifted - magic;
  const V r = (x - k * hn::Set(d, 0.693359375F)) - k * hn::Set(d, -2.12194440e-4F);
  V p = hn::Set(d, 1.3888889e-3F);
  p = p * r + hn::Set(d, 8.3333333e-3F);
  p = p * r + hn::Set(d, 4.1666667e-2F);
  p = p * r + hn::Set(d, 1.6666667e-1F);
  p = p * r + hn::Set(d, 0.5F);
  p = p * r + hn::Set(d, 1.0F);
  p = p * r + hn::Set(d, 1.0F);
  const auto scale = hn::ShiftLeft<23>(hn::BitCast(di, shifted) + hn::Set(di, 127));
  const V value = p * hn::BitCast(d, scale);
  return hn::IfThenElse(t >= hn::Set(d, 87.0F), hn::Zero(d), value);
}

/// acos(1 - u)^2 / (2 u) on 0 <= u <= 1, to 1e-8: analytic there, so a polynomial (fitted at Chebyshev nodes) does.
template <class V>
HWY_INLINE V angle_square_ratio(V u) {
  const hn::DFromV<V> d;
  V p = hn::Set(d, 0.0014233762F);
  p = p * u + hn::Set(d, -0.0031453168F);
  p = p * u + hn::Set(d, 0.0049172384F);
  p = p * u + hn::Set(d, -0.0007905127F);
  p = p * u + hn::Set(d, 0.0060830568F);
  p = p * u + hn::Set(d, 0.0140819740F);
  p = p * u + hn::Set(d, 0.0444648293F);
  p = p * u + hn::Set(d, 0.1666658914F);
  p = p * u + hn::Set(d, 1.0F);
  return p;
}

/// Rounds 0 <= v <= 2 to a multiple of 2^-22.
template <class V>
HWY_INLINE V quantised(V v) {
  const V two = hn::Set(hn::DFromV<V>(), 2.0F);
  return (v + two) - two;
}

/// In double precision: distances and angles, and who is a member; all that is left is in single precision.
void compute_exponents(const BlockField& field, const BlockNormals& normals, const ContributionParameters& parameters,
                       Exponents& exponents, BlockMask& member) {
  const Doubles d;
  const hn::Rebind<float, Doubles> df;
  const auto beta = hn::Set(d, parameters.beta);
  const auto one = hn::Set(d, 1.0);
  const auto farthest = hn::Set(d, parameters.tolerances.distance);
  const auto least_cosine = hn::Set(d, parameters.tolerances.cosine);
  const auto tiny = hn::Set(d, 1e-300);  // a gradient of length zero has no direction, but must not divide
  member = {};
  for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
    const auto f = hn::Load(d, &field.distance[i]);
    const auto gx = hn::Load(d, &field.gradient_x[i]);
    const auto gy = hn::Load(d, &field.gradient_y[i]);
    const auto gz = hn::Load(d, &field.gradient_z[i]);
    const auto dot =
        gx * hn::Load(d, &normals.x[i]) + gy * hn::Load(d, &normals.y[i]) + gz * hn::Load(d, &normals.z[i]);
    const auto cosine = parameters.unit_gradient ? dot : dot / hn::Sqrt(hn::Max(gx * gx + gy * gy + gz * gz, tiny));
    const auto scaled = f * beta;
    const auto chord = hn::Max(one - hn::Abs(cosine), hn::Zero(d));
    // Squares beyond the range of floats count as 87 in exp_negative, long before they overflow.
    hn::Store(hn::DemoteTo(df, hn::Min(scaled * scaled, hn::Set(d, 1e30))), df, &exponents.distance[i]);
    hn::Store(hn::DemoteTo(df, hn::Min(chord, one)), df, &exponents.angle_chord[i]);
    hn::Store(hn::DemoteTo(df, cosine), df, &exponents.cosine[i]);
    const auto is_member = hn::And(hn::Abs(f) <= farthest, hn::Abs(cosine) >= least_cosine);
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(d, is_member, bits.data());
    member[i / 64] |= static_cast<std::uint64_t>(bits[0]) << (i % 64);
  }
}

void contributions_of_block(const BlockField& field, const BlockNormals& normals,
                            const ContributionParameters& parameters, BlockContributions& out) {
  Exponents exponents;
  compute_exponents(field, normals, parameters, exponents, out.member);
  const Floats d;
  const auto gamma = static_cast<float>(parameters.gamma);
  const auto gamma_square = hn::Set(d, gamma * gamma);
  const auto pi = hn::Set(d, 3.14159265F);
  // The side that looks away is at least 90 degrees off: worth something only for a very forgiving gamma.
  const bool far_side_counts = parameters.gamma * parameters.gamma * 2.4674 < 20.0;
  for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
    const auto u = hn::Load(d, &exponents.angle_chord[i]);
    const auto angle_square = (u + u) * angle_square_ratio(u);
    const auto near_side = exp_negative(gamma_square * angle_square);
    auto far_side = hn::Zero(d);
    if (far_side_counts) {
      const auto far_angle = pi - hn::Sqrt(angle_square);
      far_side = exp_negative(gamma_square * (far_angle * far_angle));
    }
    const auto at_distance = exp_negative(hn::Load(d, &exponents.distance[i]));
    const auto near_score = quantised(at_distance + near_side);
    const auto far_score = quantised(at_distance + far_side);
    const auto faces_away = hn::Load(d, &exponents.cosine[i]) < hn::Zero(d);
    hn::StoreInterleaved2(hn::IfThenElse(faces_away, far_score, near_score),
                          hn::IfThenElse(faces_away, near_score, far_score), d, &out.pairs[2 * i]);
  }
}

/// How many of the magnitudes first .. last - 1 come before `magnitude`, added to `count`; `before` compares.
template <class Vector, class Counts, class Before>
HWY_INLINE Counts count_before(const double* magnitudes, std::size_t first, std::size_t last, Vector magnitude,
                               Counts count, const Before& before) {
  const Doubles d;
  const hn::RebindToSigned<Doubles> di;
  for (std::size_t q = first; q < last; ++q) {
    const auto comes_before = before(hn::Load(d, magnitudes + q * hn::Lanes(d)), magnitude);
    count = count - hn::BitCast(di, hn::VecFromMask(d, comes_before));  // a true mask is -1
  }
  return count;
}

void rank_keys_of_block(std::span<const double* const> distances, const KeyLayout& layout, std::uint64_t* keys) {
  const Doubles d;
  const hn::RebindToSigned<Doubles> di;
  const std::size_t n = distances.size();
  // The magnitudes of a few points side by side: each is read n times.
  AlignedVector<double> magnitudes(n * hn::Lanes(d));
  std::fill_n(keys, layout.words * k_block_points, 0);
  for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
    for (std::size_t p = 0; p < n; ++p) {
      hn::Store(hn::Abs(hn::Load(d, distances[p] + i)), d, &magnitudes[p * hn::Lanes(d)]);
    }
    for (std::size_t p = 0; p < n; ++p) {
      const auto magnitude = hn::Load(d, &magnitudes[p * hn::Lanes(d)]);
      auto rank = hn::Set(di, 1);
      // Ties by index: of equal magnitudes, those with a smaller index come before.
      rank = count_before(magnitudes.data(), 0, p, magnitude, rank, [](auto a, auto b) { return a <= b; });
      rank = count_before(magnitudes.data(), p + 1, n, magnitude, rank, [](auto a, auto b) { return a < b; });
      const auto inside = hn::RebindMask(di, hn::Load(d, distances[p] + i) < hn::Zero(d));
      const auto code = hn::Set(di, static_cast<std::int64_t>(n)) + hn::IfThenElse(inside, hn::Neg(rank), rank);
      auto* word = reinterpret_cast<std::int64_t*>(keys + layout.word_of(p) * k_block_points + i);
      const auto shifted = hn::ShiftLeftSame(code, static_cast<int>(layout.shift_of(p)));
      hn::Store(hn::Or(hn::Load(di, word), shifted), di, word);
    }
  }
}

}  // namespace
}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cloud2csg {

HWY_EXPORT(contributions_of_block);
HWY_EXPORT(rank_keys_of_block);

KeyLayout::KeyLayout(std::size_t primitives)
    : bits(static_cast<std::uint32_t>(std::bit_width(2 * primitives))),
      codes_per_word(64 / bits),
      words((primitives + codes_per_word - 1) / codes_per_word) {}

void compute_contributions(const BlockField& field, const BlockNormals& normals,
                           const ContributionParameters& parameters, BlockContributions& out) {
  HWY_DYNAMIC_DISPATCH(contributions_of_block)(field, normals, parameters, out);
}

void compute_rank_keys(std::span<const double* const> distances, const KeyLayout& layout, std::uint64_t* keys) {
  HWY_DYNAMIC_DISPATCH(rank_keys_of_block)(distances, layout, keys);
}

void sort_rank_keys(std::span<const double* const> distances, const KeyLayout& layout, std::uint64_t* keys) {
  const std::size_t n = distances.size();
  std::fill_n(keys, layout.words * k_block_points, 0);
  std::vector<std::uint32_t> order(n);
  for (std::size_t i = 0; i < k_block_points; ++i) {
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
      const double x = std::abs(distances[a][i]);
      const double y = std::abs(distances[b][i]);
      return x != y ? x < y : a < b;
    });
    for (std::size_t rank = 1; rank <= n; ++rank) {
      const std::uint32_t p = order[rank - 1];
      const std::uint64_t code = distances[p][i] < 0 ? n - rank : n + rank;
      keys[layout.word_of(p) * k_block_points + i] |= code << layout.shift_of(p);
    }
  }
}

}  // namespace cloud2csg
#endif  // HWY_ONCE
