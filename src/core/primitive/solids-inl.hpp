// Included once per instruction set (Highway's foreach_target), hence no ordinary include guard.
#if defined(CLOUD2CSG_PRIMITIVE_SOLIDS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOUD2CSG_PRIMITIVE_SOLIDS_INL
#undef CLOUD2CSG_PRIMITIVE_SOLIDS_INL
#else
#define CLOUD2CSG_PRIMITIVE_SOLIDS_INL
#endif

#include <span>

#include "cloud2csg/primitive.hpp"
#include "core/primitive/lanes-inl.hpp"
#include "core/primitive/placement.hpp"

/// Distance formulas of the solids that are not solids of revolution, and the frames that place a solid. A formula is
/// built once per batch of points, holds its parameters in all lanes and applies to each vector of points. It has no
/// branches, and gives a unit gradient where the distance is not differentiable.
HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {

template <class Tag>
HWY_INLINE Vector<Lanes<Tag>> broadcast_vector(Tag tag, const std::array<double, 3>& v) {
  return {broadcast(tag, v[0]), broadcast(tag, v[1]), broadcast(tag, v[2])};
}

template <class V>
HWY_INLINE V dot(const Vector<V>& a, const Vector<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class V>
HWY_INLINE Vector<V> difference(const Vector<V>& a, const Vector<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Tag>
class RotatedFrame {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE RotatedFrame(Tag tag, const Placement& placement)
      : x_axis_(broadcast_vector(tag, placement.x_axis)),
        y_axis_(broadcast_vector(tag, placement.y_axis)),
        z_axis_(broadcast_vector(tag, placement.z_axis)),
        position_(broadcast_vector(tag, placement.position)) {}

  HWY_INLINE Vector<V> to_local(const Vector<V>& point) const {
    const Vector<V> arm = difference(point, position_);
    return {dot(x_axis_, arm), dot(y_axis_, arm), dot(z_axis_, arm)};
  }

  HWY_INLINE Vector<V> direction_to_world(const Vector<V>& local) const {
    return {x_axis_.x * local.x + y_axis_.x * local.y + z_axis_.x * local.z,
            x_axis_.y * local.x + y_axis_.y * local.y + z_axis_.y * local.z,
            x_axis_.z * local.x + y_axis_.z * local.y + z_axis_.z * local.z};
  }

 private:
  Vector<V> x_axis_, y_axis_, z_axis_, position_;
};

/// The frame of a solid that is only shifted. Skipping the rotation saves a third of the arithmetic of a box.
template <class Tag>
class ShiftedFrame {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE ShiftedFrame(Tag tag, const Placement& placement) : position_(broadcast_vector(tag, placement.position)) {}

  HWY_INLINE Vector<V> to_local(const Vector<V>& point) const { return difference(point, position_); }
  HWY_INLINE Vector<V> direction_to_world(const Vector<V>& local) const { return local; }

 private:
  Vector<V> position_;
};

/// Places a solid, which a formula gives in its own frame, in the world.
template <class Frame, class Solid>
class Placed {
 public:
  using V = typename Frame::V;

  HWY_INLINE Placed(const Frame& frame, const Solid& solid) : frame_(frame), solid_(solid) {}

  HWY_INLINE Field<V> at(const Vector<V>& point) const {
    const Field<V> local = solid_.at(frame_.to_local(point));
    return {local.distance, frame_.direction_to_world(local.gradient)};
  }

 private:
  Frame frame_;
  Solid solid_;
};

/// Outside, the length of the excess beyond the faces. Inside, the distance from the nearest face's plane.
template <class Tag>
class BoxFormula {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE BoxFormula(Tag tag, const Box& box)
      : half_size_{broadcast(tag, 0.5 * box.size.x()), broadcast(tag, 0.5 * box.size.y()),
                   broadcast(tag, 0.5 * box.size.z())},
        zero_(broadcast(tag, 0.0)),
        one_(broadcast(tag, 1.0)),
        tiny_(tiny_square(tag)) {}

  HWY_INLINE Field<V> at(const Vector<V>& p) const {
    const Vector<V> excess = difference({absolute(p.x), absolute(p.y), absolute(p.z)}, half_size_);
    const Vector<V> beyond{larger(excess.x, zero_), larger(excess.y, zero_), larger(excess.z, zero_)};
    const V squared = dot(beyond, beyond);
    const V length = square_root(squared);
    const V inverse = one_ / length;
    const auto is_outside = squared > tiny_;

    const auto x_is_nearest = both(excess.x >= excess.y, excess.x >= excess.z);
    const auto y_is_nearest = excess.y >= excess.z;
    const V inner_x = select_or_zero(x_is_nearest, one_);
    const V inner_y = zero_or_select(x_is_nearest, select_or_zero(y_is_nearest, one_));
    const V inner_z = zero_or_select(x_is_nearest, zero_or_select(y_is_nearest, one_));
    const V inner_distance = larger(larger(excess.x, excess.y), excess.z);

    return {select(is_outside, length, inner_distance),
            {with_sign_of(select(is_outside, beyond.x * inverse, inner_x), p.x),
             with_sign_of(select(is_outside, beyond.y * inverse, inner_y), p.y),
             with_sign_of(select(is_outside, beyond.z * inverse, inner_z), p.z)}};
  }

 private:
  Vector<V> half_size_;
  V zero_, one_, tiny_;
};

/// Works in the world, since a sphere needs no orientation. The gradient at the centre points along z.
template <class Tag>
class SphereFormula {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE SphereFormula(Tag tag, const Sphere& sphere, const Placement& placement)
      : centre_(broadcast_vector(tag, placement.position)),
        radius_(broadcast(tag, sphere.radius)),
        one_(broadcast(tag, 1.0)),
        tiny_(tiny_square(tag)) {}

  HWY_INLINE Field<V> at(const Vector<V>& point) const {
    const Vector<V> arm = difference(point, centre_);
    const V squared = dot(arm, arm);
    const V length = square_root(squared);
    const auto is_regular = squared > tiny_;
    const V inverse = one_ / select(is_regular, length, one_);
    return {length - radius_, {arm.x * inverse, arm.y * inverse, select(is_regular, arm.z, one_) * inverse}};
  }

 private:
  Vector<V> centre_;
  V radius_, one_, tiny_;
};

template <class Tag>
class HalfSpaceFormula {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE HalfSpaceFormula(Tag tag, const Placement& placement)
      : normal_(broadcast_vector(tag, placement.z_axis)), position_(broadcast_vector(tag, placement.position)) {}

  HWY_INLINE Field<V> at(const Vector<V>& point) const { return {dot(normal_, difference(point, position_)), normal_}; }

 private:
  Vector<V> normal_, position_;
};

/// The largest of the planes' distances: exact inside and before a face, a lower bound elsewhere. The planes are in the
/// world and must outlive the formula.
template <class Tag>
class PolytopeFormula {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE PolytopeFormula(Tag tag, std::span<const WorldPlane> planes) : tag_(tag), planes_(planes) {}

  HWY_INLINE Field<V> at(const Vector<V>& point) const {
    Field<V> nearest = plane_field(planes_[0], point);
    for (const WorldPlane& plane : planes_.subspan(1)) {
      const Field<V> candidate = plane_field(plane, point);
      const auto is_nearer = candidate.distance > nearest.distance;
      nearest.distance = select(is_nearer, candidate.distance, nearest.distance);
      nearest.gradient.x = select(is_nearer, candidate.gradient.x, nearest.gradient.x);
      nearest.gradient.y = select(is_nearer, candidate.gradient.y, nearest.gradient.y);
      nearest.gradient.z = select(is_nearer, candidate.gradient.z, nearest.gradient.z);
    }
    return nearest;
  }

 private:
  HWY_INLINE Field<V> plane_field(const WorldPlane& plane, const Vector<V>& point) const {
    const Vector<V> normal{broadcast(tag_, plane.normal_x), broadcast(tag_, plane.normal_y),
                           broadcast(tag_, plane.normal_z)};
    return {dot(normal, point) - broadcast(tag_, plane.offset), normal};
  }

  [[no_unique_address]] Tag tag_;
  std::span<const WorldPlane> planes_;
};

}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
