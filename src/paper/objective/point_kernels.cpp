#include "paper/objective/point_kernels.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "paper/objective/point_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/fields/mask_bits-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// A vector of a block's numbers. At most eight doubles, so that as many floats are made of them.
template <class Real>
using Reals = std::conditional_t<sizeof(Real) == sizeof(double), hn::CappedTag<double, 8>, hn::ScalableTag<Real>>;

/// As many floats as there are Reals.
template <class Real>
using Floats = hn::Rebind<float, Reals<Real>>;

HWY_INLINE auto to_floats(hn::Vec<Reals<double>> v) {
  return hn::DemoteTo(Floats<double>(), v);
}
HWY_INLINE auto to_floats(hn::Vec<Reals<float>> v) {
  return v;
}

/// c[0] + c[1] x + c[2] x^2 ..., by Horner's rule.
template <class V, std::size_t n>
HWY_INLINE V polynomial(const std::array<float, n>& c, V x) {
  const hn::DFromV<V> d;
  V sum = hn::Set(d, c[n - 1]);
  for (std::size_t k = n - 1; k-- > 0;) sum = sum * x + hn::Set(d, c[k]);
  return sum;
}

/// 2^(-y) for y >= 0: relative error 1e-7 up to 2, absolute error 1e-7 beyond; almost 0 from 126 on. It is 2^k times a
/// minimax polynomial of degree 6 of the rest, which is at most 1/2.
template <class V>
HWY_INLINE V power_of_half(V y) {
  constexpr std::array k_coefficients{1.0F,          -0.69314721F,   0.24022652F,  -0.055503272F,
                                      9.6179945e-3F, -1.3400432e-3F, 1.5478022e-4F};
  const hn::DFromV<V> d;
  const hn::RebindToSigned<decltype(d)> di;
  const V magic = hn::Set(d, 12582912.0F);  // 1.5 * 2^23: adding to it rounds to an integer
  const V clamped = hn::Min(y, hn::Set(d, 126.0F));
  const V shifted = magic - clamped;
  const V rest = clamped + (shifted - magic);
  const auto scale = hn::ShiftLeft<23>(hn::BitCast(di, shifted) + hn::Set(di, 127));
  return polynomial(k_coefficients, rest) * hn::BitCast(d, scale);
}

/// acos(1 - u)^2 / (2 u) on 0 <= u <= 1, to 5e-8. It is analytic there, so a minimax polynomial will do.
template <class V>
HWY_INLINE V angle_square_ratio(V u) {
  constexpr std::array k_coefficients{1.0F,          0.16667211F,   0.044337514F,   0.015079435F,
                                      2.2322409e-3F, 7.3039218e-3F, -4.5281528e-3F, 2.6034803e-3F};
  return polynomial(k_coefficients, u);
}

/// 0 <= v <= 2 in units: from 2 on, the last bit of a float is one unit.
template <class V>
HWY_INLINE auto units_of(V v) {
  const hn::RebindToUnsigned<hn::DFromV<V>> d;
  return hn::BitCast(d, v + hn::Set(hn::DFromV<V>(), 2.0F)) - hn::Set(d, std::uint32_t{0x4000'0000});
}
static_assert(k_unit == 1.0 / (1U << 22U));

template <class Real>
void find_range(const BlockField<Real>& field, BlockContributions<Real>& out) {
  const Reals<Real> d;
  auto smallest = hn::Abs(hn::Load(d, field.distance.data()));
  auto largest = smallest;
  for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
    const auto magnitude = hn::Abs(hn::Load(d, &field.distance[i]));
    smallest = hn::Min(smallest, magnitude);
    largest = hn::Max(largest, magnitude);
  }
  out.smallest = hn::GetLane(hn::MinOfLanes(d, smallest));
  out.largest = hn::GetLane(hn::MaxOfLanes(d, largest));
}

template <class Real>
HWY_INLINE auto cosines(const BlockField<Real>& field, const BlockNormals<Real>& normals, bool unit_gradient,
                        std::size_t i) {
  const Reals<Real> d;
  const auto gx = hn::Load(d, &field.gradient_x[i]);
  const auto gy = hn::Load(d, &field.gradient_y[i]);
  const auto gz = hn::Load(d, &field.gradient_z[i]);
  const auto dot = gx * hn::Load(d, normals.x + i) + gy * hn::Load(d, normals.y + i) + gz * hn::Load(d, normals.z + i);
  if (unit_gradient) return dot;
  // A gradient of length zero has no direction, but must not cause a division by zero.
  const auto tiny = hn::Set(d, std::numeric_limits<Real>::min());
  return dot / hn::Sqrt(hn::Max(gx * gx + gy * gy + gz * gz, tiny));
}

/// Scores of at most 2^(-this) add up and round to zero.
constexpr double k_silent_power = 17.0 * std::numbers::log2e;

/// Work that the loop over a block may skip.
struct Shortcuts {
  bool is_far;           ///< no point's distance counts
  bool far_side_counts;  ///< see far_side_counts()
};

/// Distances, angles and memberships are in full precision, all the rest in single precision.
template <Shortcuts k_shortcuts, class Real>
void score_block(const BlockField<Real>& field, const BlockNormals<Real>& normals,
                 const ContributionParameters& parameters, BlockContributions<Real>& out) {
  const Reals<Real> d;
  const Floats<Real> df;
  const hn::RebindToUnsigned<Floats<Real>> du;
  const auto all = [d](double value) { return hn::Set(d, static_cast<Real>(value)); };
  const auto all_floats = [df](double value) { return hn::Set(df, static_cast<float>(value)); };
  const auto zero = hn::Zero(df);
  const auto farthest = all(parameters.tolerances.distance);
  const auto least_cosine = all(parameters.tolerances.cosine);
  const auto silent = all_floats(k_silent_power);
  // exp(-(beta f)^2) and exp(-(gamma angle)^2) as powers of two.
  const auto distance_scale = all(parameters.beta * std::sqrt(std::numbers::log2e));
  const auto angle_scale = all_floats(parameters.gamma * parameters.gamma * std::numbers::log2e);
  auto loudest = hn::Zero(du);
  for (std::size_t w = 0; w < out.member.size(); ++w) {
    std::uint64_t members = 0;
    std::uint64_t inside = 0;
    for (std::size_t k = 0; k < 64; k += hn::Lanes(d)) {
      const std::size_t i = 64 * w + k;
      const auto f = hn::Load(d, &field.distance[i]);
      const auto cosine = cosines(field, normals, parameters.unit_gradient, i);
      const auto is_member = hn::And(hn::Abs(f) <= farthest, hn::Abs(cosine) >= least_cosine);
      members |= bits_of(d, is_member) << k;
      inside |= bits_of(d, f < hn::Zero(d)) << k;
      const auto chord = hn::Max(all(1.0) - hn::Abs(cosine), hn::Zero(d));
      const auto u = to_floats(hn::Min(chord, all(1.0)));
      // The square of an angle is at least twice its chord.
      auto is_silent = angle_scale * (u + u) >= silent;
      auto at_distance = zero;
      if constexpr (!k_shortcuts.is_far) {
        const auto scaled = f * distance_scale;
        // 1e30 keeps squares in the range of floats; power_of_half clamps them anyway.
        const auto exponent = to_floats(hn::Min(scaled * scaled, all(1e30)));
        is_silent = hn::And(is_silent, exponent >= silent);
        // As if the block were far: a point's score must not depend on its neighbours.
        at_distance = hn::IfThenElseZero(exponent < silent, power_of_half(exponent));
      }
      if (hn::AllTrue(df, is_silent)) {
        hn::Store(hn::Zero(du), du, &out.units.plain[i]);
        hn::Store(hn::Zero(du), du, &out.units.complement[i]);
        continue;
      }
      const auto angle_square = (u + u) * angle_square_ratio(u);
      const auto near_side = power_of_half(angle_scale * angle_square);
      auto far_side = zero;
      if constexpr (k_shortcuts.far_side_counts) {
        const auto far_angle = all_floats(std::numbers::pi) - hn::Sqrt(angle_square);
        far_side = power_of_half(angle_scale * (far_angle * far_angle));
      }
      const auto near_score = units_of(at_distance + near_side);
      const auto far_score = units_of(at_distance + far_side);
      loudest = hn::Max(loudest, near_score);
      const auto faces_away = hn::RebindMask(du, to_floats(cosine) < zero);
      hn::Store(hn::IfThenElse(faces_away, far_score, near_score), du, &out.units.plain[i]);
      hn::Store(hn::IfThenElse(faces_away, near_score, far_score), du, &out.units.complement[i]);
    }
    out.member[w] = members;
    out.inside[w] = inside;
  }
  out.is_silent = hn::AllTrue(du, loudest == hn::Zero(du));
}

template <class Real>
void contributions_of_block(const BlockField<Real>& field, const BlockNormals<Real>& normals,
                            const ContributionParameters& parameters, BlockContributions<Real>& out) {
  find_range(field, out);
  // Use the number type of the loop, so that both round alike.
  const Real scaled = out.smallest * static_cast<Real>(parameters.beta * std::sqrt(std::numbers::log2e));
  const bool is_far = static_cast<float>(std::min(scaled * scaled, Real{1e30F})) >= static_cast<float>(k_silent_power);
  if (far_side_counts(parameters.gamma)) {
    if (is_far) {
      score_block<Shortcuts{.is_far = true, .far_side_counts = true}>(field, normals, parameters, out);
    } else {
      score_block<Shortcuts{.is_far = false, .far_side_counts = true}>(field, normals, parameters, out);
    }
  } else if (is_far) {
    score_block<Shortcuts{.is_far = true, .far_side_counts = false}>(field, normals, parameters, out);
  } else {
    score_block<Shortcuts{.is_far = false, .far_side_counts = false}>(field, normals, parameters, out);
  }
}

/// The lower half of a number comes first in memory.
static_assert(std::endian::native == std::endian::little);
void interleave_units(const BlockUnits& first, const BlockUnits& second, PackedPairs& out) {
  const hn::ScalableTag<std::uint32_t> d;
  auto* const target = reinterpret_cast<std::uint32_t*>(out.of.data());
  for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
    hn::StoreInterleaved4(hn::Load(d, &first.plain[i]), hn::Load(d, &first.complement[i]),
                          hn::Load(d, &second.plain[i]), hn::Load(d, &second.complement[i]), d, target + 4 * i);
  }
}

void contributions_in_double(const BlockField<double>& field, const BlockNormals<double>& normals,
                             const ContributionParameters& parameters, BlockContributions<double>& out) {
  contributions_of_block(field, normals, parameters, out);
}
void contributions_in_single(const BlockField<float>& field, const BlockNormals<float>& normals,
                             const ContributionParameters& parameters, BlockContributions<float>& out) {
  contributions_of_block(field, normals, parameters, out);
}

}  // namespace
}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cloud2csg {

HWY_EXPORT(contributions_in_double);
HWY_EXPORT(contributions_in_single);
HWY_EXPORT(interleave_units);

void compute_contributions(const BlockField<double>& field, const BlockNormals<double>& normals,
                           const ContributionParameters& parameters, BlockContributions<double>& out) {
  HWY_DYNAMIC_DISPATCH(contributions_in_double)(field, normals, parameters, out);
}
void compute_contributions(const BlockField<float>& field, const BlockNormals<float>& normals,
                           const ContributionParameters& parameters, BlockContributions<float>& out) {
  HWY_DYNAMIC_DISPATCH(contributions_in_single)(field, normals, parameters, out);
}
void interleave(const BlockUnits& first, const BlockUnits& second, PackedPairs& out) {
  HWY_DYNAMIC_DISPATCH(interleave_units)(first, second, out);
}

}  // namespace cloud2csg
#endif  // HWY_ONCE
