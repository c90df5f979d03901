#include "fitness/point_kernels.hpp"

#include <bit>
#include <limits>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fitness/point_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using Floats = hn::ScalableTag<float>;

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

/// 0 <= v <= 2 in units: above 2, the last bit of a float is one.
template <class V>
HWY_INLINE auto units_of(V v) {
  const hn::RebindToUnsigned<hn::DFromV<V>> d;
  return hn::BitCast(d, v + hn::Set(hn::DFromV<V>(), 2.0F)) - hn::Set(d, std::uint32_t{0x4000'0000});
}
static_assert(k_unit == 1.0 / (1U << 22U));

/// Plain and complement units of consecutive points, packed. Numbers are stored with their lower half first.
static_assert(std::endian::native == std::endian::little);
template <class D, class V>
HWY_INLINE void store_packed(D d, V plain, V complement, PackedContribution* out) {
  hn::StoreInterleaved2(plain, complement, d, reinterpret_cast<std::uint32_t*>(out));
}

/// Eight lanes of doubles at most, so that they fill a vector of floats.
template <class Real>
using Reals = std::conditional_t<sizeof(Real) == sizeof(double), hn::CappedTag<double, 8>, Floats>;

HWY_INLINE void store_single(Reals<double> /*tag*/, hn::Vec<Reals<double>> v, float* out) {
  const hn::Rebind<float, Reals<double>> narrow;
  hn::Store(hn::DemoteTo(narrow, v), narrow, out);
}
HWY_INLINE void store_single(Floats tag, hn::Vec<Floats> v, float* out) {
  hn::Store(v, tag, out);
}

/// Read back byte by byte: a wider load would have to wait for the store.
template <class D, class M>
HWY_INLINE std::uint64_t bits_of(D tag, M mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(tag, mask, bytes.data());
  return bytes[0] | std::uint64_t{bytes[1]} << 8U;
}
static_assert(hn::MaxLanes(Floats()) <= 16);

/// In full precision: distances and angles, and who is a member; all that is left is in single precision.
template <class Real>
void compute_exponents(const BlockField<Real>& field, const BlockNormals<Real>& normals,
                       const ContributionParameters& parameters, Exponents& exponents, BlockContributions<Real>& out) {
  const Reals<Real> d;
  const auto all = [d](double value) { return hn::Set(d, static_cast<Real>(value)); };
  const auto beta = all(parameters.beta);
  const auto one = all(1.0);
  const auto farthest = all(parameters.tolerances.distance);
  const auto least_cosine = all(parameters.tolerances.cosine);
  // A gradient of length zero has no direction, but must not divide.
  const auto tiny = hn::Set(d, std::numeric_limits<Real>::min());
  auto smallest = hn::Abs(hn::Load(d, field.distance.data()));
  auto largest = smallest;
  out.member = {};
  out.inside = {};
  for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
    const auto f = hn::Load(d, &field.distance[i]);
    const auto gx = hn::Load(d, &field.gradient_x[i]);
    const auto gy = hn::Load(d, &field.gradient_y[i]);
    const auto gz = hn::Load(d, &field.gradient_z[i]);
    const auto dot =
        gx * hn::Load(d, normals.x + i) + gy * hn::Load(d, normals.y + i) + gz * hn::Load(d, normals.z + i);
    const auto cosine = parameters.unit_gradient ? dot : dot / hn::Sqrt(hn::Max(gx * gx + gy * gy + gz * gz, tiny));
    const auto magnitude = hn::Abs(f);
    smallest = hn::Min(smallest, magnitude);
    largest = hn::Max(largest, magnitude);
    const auto scaled = f * beta;
    const auto chord = hn::Max(one - hn::Abs(cosine), hn::Zero(d));
    // Squares beyond the range of floats count as 87 in exp_negative, long before they overflow.
    store_single(d, hn::Min(scaled * scaled, all(1e30)), &exponents.distance[i]);
    store_single(d, hn::Min(chord, one), &exponents.angle_chord[i]);
    store_single(d, cosine, &exponents.cosine[i]);
    const auto is_member = hn::And(magnitude <= farthest, hn::Abs(cosine) >= least_cosine);
    out.member[i / 64] |= bits_of(d, is_member) << (i % 64);
    out.inside[i / 64] |= bits_of(d, f < hn::Zero(d)) << (i % 64);
  }
  out.smallest = hn::GetLane(hn::MinOfLanes(d, smallest));
  out.largest = hn::GetLane(hn::MaxOfLanes(d, largest));
}

/// Both parts of a score with exponents of this and more, added and rounded, are zero.
constexpr float k_silent_exponent = 17.0F;

template <class Real>
void contributions_of_block(const BlockField<Real>& field, const BlockNormals<Real>& normals,
                            const ContributionParameters& parameters, BlockContributions<Real>& out) {
  Exponents exponents;
  compute_exponents(field, normals, parameters, exponents, out);
  const Floats d;
  const auto gamma = static_cast<float>(parameters.gamma);
  const auto gamma_square = hn::Set(d, gamma * gamma);
  const auto pi = hn::Set(d, 3.14159265F);
  const auto silent = hn::Set(d, k_silent_exponent);
  const bool both_sides_count = far_side_counts(parameters.gamma);
  const hn::RebindToUnsigned<Floats> du;
  auto loudest = hn::Zero(du);
  for (std::size_t i = 0; i < k_block_points; i += hn::Lanes(d)) {
    const auto u = hn::Load(d, &exponents.angle_chord[i]);
    const auto distance_exponent = hn::Load(d, &exponents.distance[i]);
    // The square of an angle is at least twice its chord.
    const auto is_silent = hn::And(distance_exponent >= silent, gamma_square * (u + u) >= silent);
    if (hn::AllTrue(d, is_silent)) {
      store_packed(du, hn::Zero(du), hn::Zero(du), &out.packed[i]);
      continue;
    }
    const auto angle_square = (u + u) * angle_square_ratio(u);
    const auto near_side = exp_negative(gamma_square * angle_square);
    auto far_side = hn::Zero(d);
    if (both_sides_count) {
      const auto far_angle = pi - hn::Sqrt(angle_square);
      far_side = exp_negative(gamma_square * (far_angle * far_angle));
    }
    const auto at_distance = exp_negative(distance_exponent);
    const auto near_score = units_of(at_distance + near_side);
    const auto far_score = units_of(at_distance + far_side);
    loudest = hn::Max(loudest, near_score);
    const auto faces_away = hn::RebindMask(du, hn::Load(d, &exponents.cosine[i]) < hn::Zero(d));
    store_packed(du, hn::IfThenElse(faces_away, far_score, near_score),
                 hn::IfThenElse(faces_away, near_score, far_score), &out.packed[i]);
  }
  out.is_silent = hn::AllTrue(du, loudest == hn::Zero(du));
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

void compute_contributions(const BlockField<double>& field, const BlockNormals<double>& normals,
                           const ContributionParameters& parameters, BlockContributions<double>& out) {
  HWY_DYNAMIC_DISPATCH(contributions_in_double)(field, normals, parameters, out);
}
void compute_contributions(const BlockField<float>& field, const BlockNormals<float>& normals,
                           const ContributionParameters& parameters, BlockContributions<float>& out) {
  HWY_DYNAMIC_DISPATCH(contributions_in_single)(field, normals, parameters, out);
}

}  // namespace cloud2csg
#endif  // HWY_ONCE
