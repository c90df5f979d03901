// Included once per instruction set (Highway's foreach_target), hence no ordinary include guard.
#if defined(CLOUD2CSG_PRIMITIVE_DISPLACEMENT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOUD2CSG_PRIMITIVE_DISPLACEMENT_INL
#undef CLOUD2CSG_PRIMITIVE_DISPLACEMENT_INL
#else
#define CLOUD2CSG_PRIMITIVE_DISPLACEMENT_INL
#endif

#include "core/primitive/solids-inl.hpp"

/// The sine term of displaced solids, with our own sine and cosine: the C library's differ by machine and are scalar.
HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {

template <class V>
struct SineCosine {
  V sine, cosine;
};

/// Within 1e-15 for |x| < 1e4. Beyond about 1e6 the reduction is no longer exact, but values stay within [-1, 1].
template <class Tag>
class SineCosineFormula {
 public:
  using V = Lanes<Tag>;

  explicit HWY_INLINE SineCosineFormula(Tag tag) : tag_(tag), one_(all(1.0)) {}

  HWY_INLINE SineCosine<V> at(V x) const {
    // x = quarters * pi / 2 + rest, |rest| <= pi / 4 (Cody and Waite). pi / 2 is in three parts, those of fdlibm, whose
    // products with a count below 2^20 are exact.
    const V quarters = rounded(x * all(0.63661977236758134308));
    const V high = x - quarters * all(1.57079632673412561417e+00);
    const V middle = high - quarters * all(6.07710050630396597660e-11);
    const V rest = middle - quarters * all(2.02226624879595063154e-21);

    const V sine = sine_near_zero(rest);
    const V cosine = cosine_near_zero(rest);

    const V quadrant = quarters - all(4.0) * rounded(quarters * all(0.25) - all(0.375));
    const auto is_first = quadrant == one_;
    const auto is_third = quadrant == all(3.0);
    const auto is_second = quadrant == all(2.0);
    const auto is_odd = either(is_first, is_third);
    const V plain_sine = select(is_odd, cosine, sine);
    const V plain_cosine = select(is_odd, sine, cosine);
    return {clamped(select(either(is_second, is_third), negated(plain_sine), plain_sine)),
            clamped(select(either(is_first, is_second), negated(plain_cosine), plain_cosine))};
  }

 private:
  HWY_INLINE V all(double value) const { return broadcast(tag_, value); }

  /// Rounds to the nearest integer, for magnitudes below 2^51: adding 1.5 * 2^52 leaves no room for a fraction.
  HWY_INLINE V rounded(V x) const {
    const V shift = all(6755399441055744.0);
    return (x + shift) - shift;
  }

  /// The minimax polynomials of fdlibm for |x| <= pi / 4.
  HWY_INLINE V sine_near_zero(V x) const {
    const V z = x * x;
    V sum = all(1.58969099521155010221e-10) * z + all(-2.50507602534068634195e-08);
    sum = sum * z + all(2.75573137070700676789e-06);
    sum = sum * z + all(-1.98412698298579493134e-04);
    sum = sum * z + all(8.33333333332248946124e-03);
    sum = sum * z + all(-1.66666666666666324348e-01);
    return x + x * (z * sum);
  }

  HWY_INLINE V cosine_near_zero(V x) const {
    const V z = x * x;
    V sum = all(-1.13596475577881948265e-11) * z + all(2.08757232129817482790e-09);
    sum = sum * z + all(-2.75573143513906633035e-07);
    sum = sum * z + all(2.48015872894767294178e-05);
    sum = sum * z + all(-1.38888888888741095749e-03);
    sum = sum * z + all(4.16666666666666019037e-02);
    return (one_ - all(0.5) * z) + z * (z * sum);
  }

  HWY_INLINE V clamped(V x) const { return larger(smaller(x, one_), negated(one_)); }

  [[no_unique_address]] Tag tag_;
  V one_;
};

/// Adds sin(kx) sin(ky) sin(kz) in the solid's frame. Keeps the undisplaced gradient where the sum vanishes.
template <class Tag>
class DisplacementFormula {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE DisplacementFormula(Tag tag, double frequency, const Placement& placement)
      : frame_(tag, placement), sine_cosine_(tag), frequency_(broadcast(tag, frequency)), tiny_(tiny_square(tag)) {}

  HWY_INLINE Field<V> added_to(const Field<V>& base, const Vector<V>& point) const {
    const Vector<V> local = frame_.to_local(point);
    const SineCosine<V> x = sine_cosine_.at(frequency_ * local.x);
    const SineCosine<V> y = sine_cosine_.at(frequency_ * local.y);
    const SineCosine<V> z = sine_cosine_.at(frequency_ * local.z);
    const Vector<V> slope =
        frame_.direction_to_world({frequency_ * (x.cosine * y.sine * z.sine), frequency_ * (x.sine * y.cosine * z.sine),
                                   frequency_ * (x.sine * y.sine * z.cosine)});
    const Vector<V> sum{base.gradient.x + slope.x, base.gradient.y + slope.y, base.gradient.z + slope.z};
    const auto vanishes = dot(sum, sum) < tiny_;
    return {base.distance + x.sine * y.sine * z.sine,
            {select(vanishes, base.gradient.x, sum.x), select(vanishes, base.gradient.y, sum.y),
             select(vanishes, base.gradient.z, sum.z)}};
  }

 private:
  RotatedFrame<Tag> frame_;
  SineCosineFormula<Tag> sine_cosine_;
  V frequency_, tiny_;
};

}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
