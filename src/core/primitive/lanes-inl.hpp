// Included once per instruction set (Highway's foreach_target), hence no ordinary include guard.
#if defined(CLOUD2CSG_PRIMITIVE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOUD2CSG_PRIMITIVE_LANES_INL
#undef CLOUD2CSG_PRIMITIVE_LANES_INL
#else
#define CLOUD2CSG_PRIMITIVE_LANES_INL
#endif

#include <hwy/highway.h>

#include <cmath>

/// The operations that the formulas use, for one double (tag PlainTag) and for a Highway vector of doubles or floats
/// (tag hn::ScalableTag<double>, <float>). All are exact in the sense of IEEE 754 and choose alike between equal
/// operands and between zeros of either sign, so that a formula gives the same bits in every instruction set.
HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One point at a time: the plain reference.
struct PlainTag {};

HWY_INLINE double broadcast(PlainTag /*tag*/, double value) {
  return value;
}
HWY_INLINE double square_root(double a) {
  return std::sqrt(a);
}
HWY_INLINE double absolute(double a) {
  return std::abs(a);
}
HWY_INLINE double smaller(double a, double b) {
  return a < b ? a : b;
}
HWY_INLINE double larger(double a, double b) {
  return a > b ? a : b;
}
HWY_INLINE double with_sign_of(double magnitude, double sign) {
  return std::copysign(magnitude, sign);
}
HWY_INLINE double negated(double a) {
  return -a;
}
HWY_INLINE double select(bool condition, double yes, double no) {
  return condition ? yes : no;
}
HWY_INLINE double select_or_zero(bool condition, double yes) {
  return condition ? yes : 0.0;
}
HWY_INLINE double zero_or_select(bool condition, double no) {
  return condition ? 0.0 : no;
}
HWY_INLINE bool both(bool a, bool b) {
  return a && b;
}
HWY_INLINE bool either(bool a, bool b) {
  return a || b;
}

template <class Tag>
HWY_INLINE hn::Vec<Tag> broadcast(Tag tag, double value) {
  return hn::Set(tag, static_cast<hn::TFromD<Tag>>(value));
}
template <class V>
HWY_INLINE V square_root(V a) {
  return hn::Sqrt(a);
}
template <class V>
HWY_INLINE V absolute(V a) {
  return hn::Abs(a);
}
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
// x86's minpd and maxpd are exactly the comparison below: the second operand where both are equal.
template <class V>
HWY_INLINE V smaller(V a, V b) {
  return hn::Min(a, b);
}
template <class V>
HWY_INLINE V larger(V a, V b) {
  return hn::Max(a, b);
}
#else
template <class V>
HWY_INLINE V smaller(V a, V b) {
  return hn::IfThenElse(a < b, a, b);
}
template <class V>
HWY_INLINE V larger(V a, V b) {
  return hn::IfThenElse(a > b, a, b);
}
#endif
template <class V>
HWY_INLINE V with_sign_of(V magnitude, V sign) {
  return hn::CopySign(magnitude, sign);
}
template <class V>
HWY_INLINE V negated(V a) {
  return hn::Neg(a);
}
template <class M, class V>
HWY_INLINE V select(M condition, V yes, V no) {
  return hn::IfThenElse(condition, yes, no);
}
template <class M, class V>
HWY_INLINE V select_or_zero(M condition, V yes) {
  return hn::IfThenElseZero(condition, yes);
}
template <class M, class V>
HWY_INLINE V zero_or_select(M condition, V no) {
  return hn::IfThenZeroElse(condition, no);
}
template <class M>
HWY_INLINE M both(M a, M b) {
  return hn::And(a, b);
}
template <class M>
HWY_INLINE M either(M a, M b) {
  return hn::Or(a, b);
}

/// The number type of a tag: double, or a vector.
template <class Tag>
using Lanes = decltype(broadcast(Tag(), 0.0));

template <class V>
struct Vector {
  V x, y, z;
};

/// Signed distance and its gradient, one point per lane.
template <class V>
struct Field {
  V distance;
  Vector<V> gradient;
};

/// Squares below this count as zero. Roots of larger squares can be multiplied and inverted without overflow.
HWY_INLINE double tiny_square(PlainTag /*tag*/) {
  return 1e-280;
}
template <class Tag>
HWY_INLINE hn::Vec<Tag> tiny_square(Tag tag) {
  return broadcast(tag, sizeof(hn::TFromD<Tag>) == sizeof(double) ? 1e-280 : 1e-34);
}

}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
