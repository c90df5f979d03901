// Included once per instruction set (Highway's foreach_target), hence no ordinary include guard.
#if defined(CLOUD2CSG_PRIMITIVE_REVOLVED_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOUD2CSG_PRIMITIVE_REVOLVED_INL
#undef CLOUD2CSG_PRIMITIVE_REVOLVED_INL
#else
#define CLOUD2CSG_PRIMITIVE_REVOLVED_INL
#endif

#include <cmath>

#include "core/primitive/solids-inl.hpp"

/// Solids of revolution about local z, each from a formula in the half plane (r, z), r >= 0.
HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {

/// The gradient is direction / length. The caller divides, because it also divides by r and does both at once.
template <class V>
struct ProfileField {
  V distance;
  V direction_r, direction_z;
  V length;  ///< length of the direction, never zero
};

/// The rectangle r <= radius, |z| <= height / 2.
template <class Tag>
class CylinderProfile {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE CylinderProfile(Tag tag, const Cylinder& cylinder)
      : radius_(broadcast(tag, cylinder.radius)),
        half_height_(broadcast(tag, 0.5 * cylinder.height)),
        zero_(broadcast(tag, 0.0)),
        one_(broadcast(tag, 1.0)),
        tiny_(tiny_square(tag)) {}

  HWY_INLINE ProfileField<V> at(V r, V z) const {
    const V excess_r = r - radius_;
    const V excess_z = absolute(z) - half_height_;
    const V beyond_r = larger(excess_r, zero_);
    const V beyond_z = larger(excess_z, zero_);
    const V squared = beyond_r * beyond_r + beyond_z * beyond_z;
    const auto is_outside = squared > tiny_;
    const auto side_is_nearest = excess_r >= excess_z;
    const V length = select(is_outside, square_root(squared), one_);
    const V direction_r = select(is_outside, beyond_r, select_or_zero(side_is_nearest, one_));
    const V direction_z = select(is_outside, beyond_z, zero_or_select(side_is_nearest, one_));
    return {select(is_outside, length, larger(excess_r, excess_z)), direction_r, with_sign_of(direction_z, z), length};
  }

 private:
  V radius_, half_height_, zero_, one_, tiny_;
};

/// A trapezoid with one side on the axis: the nearer of the slanted edge and the cap on the point's side.
template <class Tag>
class ConeProfile {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE ConeProfile(Tag tag, const Cone& cone)
      : ConeProfile(tag, cone, std::hypot(cone.radius_top - cone.radius_bottom, cone.height)) {}

  HWY_INLINE ProfileField<V> at(V r, V z) const {
    const V cap_radius = select(z < zero_, radius_bottom_, radius_top_);
    const V cap_r = larger(r - cap_radius, zero_);
    const V cap_z = absolute(z) - half_height_;
    const V cap_squared = cap_r * cap_r + cap_z * cap_z;

    const V arm_r = r - radius_bottom_;
    const V arm_z = z + half_height_;
    const V along = arm_r * tangent_r_ + arm_z * tangent_z_;
    const V across = arm_r * tangent_z_ - arm_z * tangent_r_;  // the outward normal is (tangent_z, -tangent_r)
    const V beyond = along - smaller(larger(along, zero_), slant_);
    const V slant_squared = beyond * beyond + across * across;

    const auto cap_is_nearest = cap_squared < slant_squared;
    const V squared = select(cap_is_nearest, cap_squared, slant_squared);
    const auto is_inside = both(cap_z < zero_, across < zero_);
    const auto is_regular = squared > tiny_;
    const V length = select(is_regular, square_root(squared), one_);
    const V outward = select(is_inside, minus_one_, one_);
    const V distance = select_or_zero(is_regular, length);

    // From the nearest point of the edge to the point, turned outward. On the edge, the edge's normal.
    const V across_or_unit = select(is_regular, across * outward, one_);
    const V beyond_outward = select_or_zero(is_regular, beyond * outward);
    const V slant_r = beyond_outward * tangent_r_ + across_or_unit * tangent_z_;
    const V slant_z = beyond_outward * tangent_z_ - across_or_unit * tangent_r_;
    const V up = select(is_regular, cap_z * outward, one_);
    const V cap_direction_r = select_or_zero(is_regular, cap_r * outward);
    return {distance * outward, select(cap_is_nearest, cap_direction_r, slant_r),
            select(cap_is_nearest, select(z < zero_, negated(up), up), slant_z), length};
  }

 private:
  HWY_INLINE ConeProfile(Tag tag, const Cone& cone, double slant)
      : radius_bottom_(broadcast(tag, cone.radius_bottom)),
        radius_top_(broadcast(tag, cone.radius_top)),
        half_height_(broadcast(tag, 0.5 * cone.height)),
        slant_(broadcast(tag, slant)),
        tangent_r_(broadcast(tag, (cone.radius_top - cone.radius_bottom) / slant)),
        tangent_z_(broadcast(tag, cone.height / slant)),
        zero_(broadcast(tag, 0.0)),
        one_(broadcast(tag, 1.0)),
        minus_one_(broadcast(tag, -1.0)),
        tiny_(tiny_square(tag)) {}

  V radius_bottom_, radius_top_, half_height_, slant_, tangent_r_, tangent_z_, zero_, one_, minus_one_, tiny_;
};

/// A circle of minor radius about (major radius, 0).
template <class Tag>
class TorusProfile {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE TorusProfile(Tag tag, const Torus& torus)
      : major_radius_(broadcast(tag, torus.major_radius)),
        minor_radius_(broadcast(tag, torus.minor_radius)),
        one_(broadcast(tag, 1.0)),
        tiny_(tiny_square(tag)) {}

  HWY_INLINE ProfileField<V> at(V r, V z) const {
    const V arm_r = r - major_radius_;
    const V squared = arm_r * arm_r + z * z;
    const V length = square_root(squared);
    const auto is_regular = squared > tiny_;
    return {length - minor_radius_, select(is_regular, arm_r, one_), z, select(is_regular, length, one_)};
  }

 private:
  V major_radius_, minor_radius_, one_, tiny_;
};

/// The solid of revolution of a profile about local z. On the axis the radial direction is local x.
template <class Tag, class Profile>
class Revolved {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE Revolved(Tag tag, const Profile& profile)
      : profile_(profile), one_(broadcast(tag, 1.0)), tiny_(tiny_square(tag)) {}

  HWY_INLINE Field<V> at(const Vector<V>& p) const {
    const V squared = p.x * p.x + p.y * p.y;
    const V r = square_root(squared);
    const ProfileField<V> profile = profile_.at(r, p.z);

    const auto is_regular = squared > tiny_;
    const V r_or_one = select(is_regular, r, one_);
    const V x_or_one = select(is_regular, p.x, one_);
    const V inverse = one_ / (profile.length * r_or_one);
    const V radial = profile.direction_r * inverse;
    return {profile.distance, {x_or_one * radial, p.y * radial, profile.direction_z * (inverse * r_or_one)}};
  }

 private:
  Profile profile_;
  V one_, tiny_;
};

}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
