// Included once per instruction set (Highway's foreach_target), hence no ordinary include guard.
#if defined(CLOUD2CSG_PRIMITIVE_PROFILE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOUD2CSG_PRIMITIVE_PROFILE_INL
#undef CLOUD2CSG_PRIMITIVE_PROFILE_INL
#else
#define CLOUD2CSG_PRIMITIVE_PROFILE_INL
#endif

#include <cmath>
#include <span>

#include "core/primitive/placement.hpp"
#include "core/primitive/revolved-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {

/// The region inside an odd number of closed paths of lines and arcs. The nearest edge gives the distance. Edges that a
/// ray towards +x crosses give the sign: those of the polygon of chords, and for each arc the circular segment beside
/// its chord. The edges must outlive the formula.
template <class Tag>
class PathsProfile {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE PathsProfile(Tag tag, std::span<const ProfileEdge> edges)
      : tag_(tag),
        edges_(edges),
        zero_(broadcast(tag, 0.0)),
        one_(broadcast(tag, 1.0)),
        minus_one_(broadcast(tag, -1.0)),
        tiny_(tiny_square(tag)) {}

  HWY_INLINE ProfileField<V> at(V x, V y) const {
    constexpr double k_far = 1e37;  // nearly the largest float
    Nearest nearest{.squared = set(k_far), .at_corner = zero_, .arm = {zero_, zero_}, .normal = {one_, zero_}};
    V sign = one_;
    for (const ProfileEdge& edge : edges_) {
      const Pair arm{x - set(edge.start_x), y - set(edge.start_y)};
      const V side = set(edge.along_x) * arm.y - set(edge.along_y) * arm.x;
      // The polygon and the circular segment must agree on which side of the chord a place is, so one value decides.
      const V left = select(edge.is_left_on_chord ? side >= zero_ : side > zero_, one_, minus_one_);
      const V above_start = select(y >= set(edge.start_y), one_, minus_one_);
      const V above_end = select(y >= set(edge.end_y), one_, minus_one_);
      const auto is_spanned = above_start * above_end < zero_;
      const auto is_hit = left * set(edge.up) > zero_;
      sign = select(both(is_spanned, is_hit), negated(sign), sign);
      const Nearest of_edge = edge.is_arc ? nearest_of_arc(edge, x, y, arm, left, sign) : nearest_of_line(edge, arm);
      if (edge.has_surface) take_nearer(nearest, of_edge);
    }
    const V length = square_root(nearest.squared);
    const auto is_corner = both(nearest.at_corner > zero_, nearest.squared > tiny_);
    return {sign * length, select(is_corner, sign * nearest.arm.x, nearest.normal.x),
            select(is_corner, sign * nearest.arm.y, nearest.normal.y), select(is_corner, length, one_)};
  }

 private:
  struct Pair {
    V x, y;
  };
  /// The nearest point of an edge, and the unit normal there, which rounding does not turn however near the place is.
  /// If it is a corner (1, else 0), the gradient is along the arm from there to the place.
  struct Nearest {
    V squared, at_corner;
    Pair arm, normal;
  };

  HWY_INLINE V set(double value) const { return broadcast(tag_, value); }

  HWY_INLINE Nearest nearest_of_line(const ProfileEdge& edge, const Pair& arm) const {
    const V along = (arm.x * set(edge.along_x) + arm.y * set(edge.along_y)) * set(edge.inverse_square);
    const V across = arm.x * set(edge.normal_x) + arm.y * set(edge.normal_y);
    const auto is_beside = both(along > zero_, along < one_);
    const V share = select(along > zero_, one_, zero_);
    const Pair rest{arm.x - share * set(edge.along_x), arm.y - share * set(edge.along_y)};
    return {select(is_beside, across * across, rest.x * rest.x + rest.y * rest.y),
            select(is_beside, zero_, one_),
            rest,
            {set(edge.normal_x), set(edge.normal_y)}};
  }

  /// Also turns the sign inside the circular segment. Avoids differences of large numbers, because the circle of a flat
  /// arc is large.
  HWY_INLINE Nearest nearest_of_arc(const ProfileEdge& edge, V x, V y, const Pair& arm, V left, V& sign) const {
    const Pair radial{x - set(edge.centre_x), y - set(edge.centre_y)};
    const V squared = radial.x * radial.x + radial.y * radial.y;
    const V length = square_root(squared);
    const V turn = set(edge.turn);
    const V start_squared = arm.x * arm.x + arm.y * arm.y;
    const V along_radius = arm.x * set(edge.outward_x) + arm.y * set(edge.outward_y);
    const V radius = set(edge.radius);
    const V off = (start_squared + (radius + radius) * along_radius) / (length + radius);
    const auto is_beyond_chord = left * turn < zero_;
    sign = select(both(is_beyond_chord, off < zero_), negated(sign), sign);

    const Pair end_arm{arm.x - set(edge.along_x), arm.y - set(edge.along_y)};
    const auto is_after_start = arm.x * set(edge.first_x) + arm.y * set(edge.first_y) > zero_;
    const auto is_before_end = end_arm.x * set(edge.last_x) + end_arm.y * set(edge.last_y) < zero_;
    const auto is_beside =
        edge.is_long_arc ? either(is_after_start, is_before_end) : both(is_after_start, is_before_end);
    const V end_squared = end_arm.x * end_arm.x + end_arm.y * end_arm.y;
    const auto start_is_nearer = start_squared < end_squared;
    const auto is_regular = squared > tiny_;
    const V inverse = turn / select(is_regular, length, one_);
    return {select(is_beside, off * off, select(start_is_nearer, start_squared, end_squared)),
            select(is_beside, zero_, one_),
            {select(start_is_nearer, arm.x, end_arm.x), select(start_is_nearer, arm.y, end_arm.y)},
            {select(is_regular, radial.x * inverse, set(edge.normal_x)),
             select(is_regular, radial.y * inverse, set(edge.normal_y))}};
  }

  HWY_INLINE static void take_nearer(Nearest& nearest, const Nearest& other) {
    const auto is_nearer = other.squared < nearest.squared;
    const auto nearer = [&is_nearer](const Pair& yes, const Pair& no) {
      return Pair{select(is_nearer, yes.x, no.x), select(is_nearer, yes.y, no.y)};
    };
    nearest.squared = select(is_nearer, other.squared, nearest.squared);
    nearest.at_corner = select(is_nearer, other.at_corner, nearest.at_corner);
    nearest.arm = nearer(other.arm, nearest.arm);
    nearest.normal = nearer(other.normal, nearest.normal);
  }

  [[no_unique_address]] Tag tag_;
  std::span<const ProfileEdge> edges_;
  V zero_, one_, minus_one_, tiny_;
};

/// The profile times |z| <= height / 2.
template <class Tag>
class ExtrusionFormula {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE ExtrusionFormula(Tag tag, std::span<const ProfileEdge> edges, double height)
      : profile_(tag, edges),
        half_height_(broadcast(tag, 0.5 * height)),
        zero_(broadcast(tag, 0.0)),
        one_(broadcast(tag, 1.0)),
        tiny_(tiny_square(tag)) {}

  HWY_INLINE Field<V> at(const Vector<V>& p) const {
    const ProfileField<V> side = profile_.at(p.x, p.y);
    const V excess_z = absolute(p.z) - half_height_;
    const V beyond_side = larger(side.distance, zero_);
    const V beyond_z = larger(excess_z, zero_);
    const V squared = beyond_side * beyond_side + beyond_z * beyond_z;
    const auto is_outside = squared > tiny_;
    const V length = select(is_outside, square_root(squared), one_);
    const auto side_is_nearest = side.distance >= excess_z;
    const V share = select(is_outside, beyond_side, select_or_zero(side_is_nearest, one_)) / (length * side.length);
    const V share_z = select(is_outside, beyond_z, zero_or_select(side_is_nearest, one_)) / length;
    return {select(is_outside, length, larger(side.distance, excess_z)),
            {share * side.direction_r, share * side.direction_z, with_sign_of(share_z, p.z)}};
  }

 private:
  PathsProfile<Tag> profile_;
  V half_height_, zero_, one_, tiny_;
};

/// The profile turned about local z by less than a full turn. `sides` are the edges without those on the axis, `caps`
/// all edges. In a frame whose x axis is in the middle of the sector, places are mirrored to y >= 0, so only one cap
/// counts.
template <class Tag>
class SectorFormula {
 public:
  using V = Lanes<Tag>;

  HWY_INLINE SectorFormula(Tag tag, std::span<const ProfileEdge> sides, std::span<const ProfileEdge> caps, double angle)
      : turned_(tag, PathsProfile<Tag>(tag, sides)),
        cap_(tag, caps),
        cosine_(broadcast(tag, std::cos(0.5 * angle))),
        sine_(broadcast(tag, std::sin(0.5 * angle))),
        zero_(broadcast(tag, 0.0)),
        one_(broadcast(tag, 1.0)),
        tiny_(tiny_square(tag)) {}

  HWY_INLINE Field<V> at(const Vector<V>& p) const {
    const V middle_x = p.x * cosine_ + p.y * sine_;
    const V middle_y = p.y * cosine_ - p.x * sine_;
    // In the plane of the nearer cap, and off it.
    const V along = middle_x * cosine_ + absolute(middle_y) * sine_;
    const V off = absolute(middle_y) * cosine_ - middle_x * sine_;
    const ProfileField<V> cap = cap_.at(along, p.z);
    const V beyond = larger(cap.distance, zero_);
    const V squared = beyond * beyond + off * off;
    const auto is_regular = squared > tiny_;
    const V length = select(is_regular, square_root(squared), one_);
    const auto is_within = zero_ >= off;
    const V distance = select_or_zero(is_regular, select(is_within, negated(length), length));
    const V share = select(is_within, negated(one_), one_) / length;
    const V share_beyond = select_or_zero(is_regular, beyond * share) / cap.length;
    const V gradient_along = share_beyond * cap.direction_r;
    const V gradient_off = select(is_regular, off * share, one_);
    const V gradient_x = gradient_along * cosine_ - gradient_off * sine_;
    const V folded_y = gradient_along * sine_ + gradient_off * cosine_;
    const V gradient_y = select(middle_y < zero_, negated(folded_y), folded_y);

    const Field<V> side = turned_.at(p);
    const auto is_side = both(is_within, side.distance >= distance);
    return {select(is_side, side.distance, distance),
            {select(is_side, side.gradient.x, gradient_x * cosine_ - gradient_y * sine_),
             select(is_side, side.gradient.y, gradient_x * sine_ + gradient_y * cosine_),
             select(is_side, side.gradient.z, share_beyond * cap.direction_z)}};
  }

 private:
  Revolved<Tag, PathsProfile<Tag>> turned_;
  PathsProfile<Tag> cap_;
  V cosine_, sine_, zero_, one_, tiny_;
};

}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
