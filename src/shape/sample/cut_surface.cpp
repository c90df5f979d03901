#include "shape/sample/cut_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "core/primitive/profile.hpp"
#include "core/primitive/shape.hpp"

namespace cloud2csg {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

/// The middle of a triangle or a line, or of an arc's sweep.
Vector3d middle_of(const Triangle& triangle) {
  return (triangle[0] + triangle[1] + triangle[2]) / 3;
}

Vector2d middle_of(const ProfileSegment& segment) {
  return segment.at(0.5);
}

/// No point of the piece is farther from its middle.
double reach_of(const Triangle& triangle) {
  const Vector3d middle = middle_of(triangle);
  double reach = 0;
  for (const Vector3d& corner : triangle) reach = std::max(reach, (corner - middle).stableNorm());
  return reach;
}

double reach_of(const ProfileSegment& segment) {
  return 0.5 * segment.length();
}

/// Cuts the longest edge.
std::array<Triangle, 2> halves_of(const Triangle& triangle) {
  std::size_t longest = 0;
  double most = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = (triangle[(i + 1) % 3] - triangle[i]).stableNorm();
    if (length > most) most = length, longest = i;
  }
  const auto& [a, b, c] = std::tie(triangle[longest], triangle[(longest + 1) % 3], triangle[(longest + 2) % 3]);
  const Vector3d middle = 0.5 * a + 0.5 * b;
  return {Triangle{a, middle, c}, Triangle{middle, b, c}};
}

std::array<ProfileSegment, 2> halves_of(const ProfileSegment& segment) {
  const Vector2d middle = middle_of(segment);
  const double bulge = std::tan(std::atan(segment.bulge) / 2);
  return {segment_between(segment.start, bulge, middle), segment_between(middle, bulge, segment.end)};
}

/// Whether halves of a piece at this place would differ. Far from the origin, doubles do not resolve smaller ones.
template <class Vector>
bool is_divisible(double length, const Vector& place) {
  constexpr double k_digits = 1e-14;  // some 50 times the rounding
  return length > k_digits * place.stableNorm();
}

/// The pieces' parts that come within the radius of the centre, and some beyond it. O(log(size / radius)) parts a
/// piece.
template <class Piece, class Vector>
std::vector<Piece> near(std::vector<Piece> pieces, const Vector& centre, double radius) {
  constexpr double k_small = 0.125;  // more leaves more outside, less makes more parts
  std::vector<Piece> found;
  while (!pieces.empty()) {
    const Piece piece = pieces.back();
    pieces.pop_back();
    const Vector middle = middle_of(piece);
    const double distance = (middle - centre).stableNorm();
    const double reach = reach_of(piece);
    if (distance > radius + reach) continue;
    if (distance + reach > radius && reach > k_small * radius && is_divisible(reach, middle)) {
      for (const Piece& half : halves_of(piece)) pieces.push_back(half);
    } else {
      found.push_back(piece);
    }
  }
  return found;
}

/// Area to the left of closed paths within the box: Green's theorem for paths that are moved into the box, which leaves
/// the winding about every place in it.
double area_within(std::vector<ProfileSegment> segments, const AlignedBox2d& box) {
  constexpr double k_small = 0.125;  // of the box's diagonal; a longer piece could cut a corner of the box
  constexpr int k_steps = 256;  // halved, the error of an arc is four times as large; with this, 1e-4 of its circle
  const auto moved = [&box](const Vector2d& v) -> Vector2d { return v.cwiseMax(box.min()).cwiseMin(box.max()); };
  const double middle = box.center().y();  // about the origin, a far box would lose the digits of its area
  double area = 0;
  while (!segments.empty()) {
    const ProfileSegment segment = segments.back();
    segments.pop_back();
    const AlignedBox2d extent = bounds_of(std::span(&segment, 1));
    const bool is_aside =
        (extent.min().array() >= box.max().array()).any() || (extent.max().array() <= box.min().array()).any();
    const double length = segment.length();
    if (!is_aside && length > k_small * box.diagonal().norm() && is_divisible(length, segment.start)) {
      for (const ProfileSegment& half : halves_of(segment)) segments.push_back(half);
      continue;
    }
    Vector2d last = moved(segment.start);
    for (int i = 1; i <= k_steps; ++i) {
      const Vector2d next = moved(i == k_steps ? segment.end : segment.at(static_cast<double>(i) / k_steps));
      area -= (next.x() - last.x()) * (0.5 * (last.y() + next.y()) - middle);
      last = next;
    }
  }
  // No place is found in an area of rounding errors.
  constexpr double k_least_share = 1e-9;
  return area > k_least_share * box.volume() ? area : 0;
}

/// Makes surfaces in the primitive's own frame. The caller places them in the world.
class CutSurface {
 public:
  CutSurface(const Pose& pose, const AlignedBox& region)
      // The slack keeps what touches the ball.
      : centre_(pose.to_local(region.center())), radius_(0.5 * (1 + 1e-9) * region.diagonal().stableNorm()) {}

  PrimitiveSurface operator()(const Box& box) const {
    std::vector<Triangle> triangles;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-0.5, 0.5}) {
        const auto corner = [&](double u, double v) -> Vector3d {
          Vector3d shares;
          shares[axis] = side;
          shares[(axis + 1) % 3] = side < 0 ? v : u;
          shares[(axis + 2) % 3] = side < 0 ? u : v;
          return box.size.cwiseProduct(shares);
        };
        triangles.push_back({corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5)});
        triangles.push_back({corner(-0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)});
      }
    }
    return of_triangles(std::move(triangles));
  }

  PrimitiveSurface operator()(const Sphere& sphere) const {
    return turned({segment_between({0, -sphere.radius}, 1, {0, sphere.radius})});
  }

  PrimitiveSurface operator()(const Cylinder& cylinder) const {
    return (*this)(Cone{.radius_bottom = cylinder.radius, .radius_top = cylinder.radius, .height = cylinder.height});
  }

  PrimitiveSurface operator()(const Cone& cone) const {
    const double end = 0.5 * cone.height;
    return turned({segment_between({0, -end}, 0, {cone.radius_bottom, -end}),
                   segment_between({cone.radius_bottom, -end}, 0, {cone.radius_top, end}),
                   segment_between({cone.radius_top, end}, 0, {0, end})});
  }

  PrimitiveSurface operator()(const Torus& torus) const {
    const Vector2d below(torus.major_radius, -torus.minor_radius);
    const Vector2d above(torus.major_radius, torus.minor_radius);
    return turned({segment_between(below, 1, above), segment_between(above, 1, below)});
  }

  PrimitiveSurface operator()(const Revolution& revolution) const {
    return with_caps(turned(segments_of(revolution.profile), turn_of(revolution)), revolution);
  }

  PrimitiveSurface operator()(const Polytope& polytope) const { return of_triangles(triangles_of(polytope)); }

  PrimitiveSurface operator()(const Extrusion& extrusion) const {
    const std::vector<ProfileSegment> segments = segments_of(extrusion.profile);
    const Vector2d middle = centre_.head<2>();
    const double end = 0.5 * extrusion.height;
    const double lower = std::max(-end, centre_.z() - radius_);
    const double upper = std::min(end, centre_.z() + radius_);
    const std::vector<ProfileSegment> sides = near(segments, middle, radius_);
    std::vector<double> areas;
    areas.reserve(sides.size());
    for (const ProfileSegment& side : sides) areas.push_back(side.length() * std::max(upper - lower, 0.0));
    const WeightedChoice choice(areas);
    const auto draw = [sides, choice, lower, upper](RandomStream& random) {
      const ProfileSegment& side = sides[choice.draw(random)];
      const double share = random.uniform();
      const Vector2d place = side.at(share);
      const Vector2d normal = side.normal(share);
      return SurfacePoint{.position = {place.x(), place.y(), random.uniform(lower, upper)},
                          .normal = {normal.x(), normal.y(), 0}};
    };
    return with_caps({.area = choice.total(), .draw = draw}, extrusion);
  }

  /// Both are unbounded.
  PrimitiveSurface operator()(const HalfSpace& /*half_space*/) const { return {}; }
  PrimitiveSurface operator()(const Expression& /*expression*/) const { return {}; }

 private:
  /// What a profile's segments sweep when they turn about z from +x by the angle.
  [[nodiscard]] PrimitiveSurface turned(std::vector<ProfileSegment> segments, double angle = 2 * pi) const {
    const double off = std::hypot(centre_.x(), centre_.y());
    const double half = off > radius_ ? std::asin(radius_ / off) : pi;
    // Turned into one half-plane, the ball becomes a disc.
    segments = near(std::move(segments), Vector2d(off, centre_.z()), radius_);
    const double middle = std::atan2(centre_.y(), centre_.x());
    if (angle >= 2 * pi) return turned_surface(std::move(segments), middle - half, middle + half);
    const double from_middle = std::remainder(middle - 0.5 * angle, 2 * pi);
    if (std::abs(from_middle) + half > pi) return turned_surface(std::move(segments), 0, angle);
    const double from = std::max(0.0, 0.5 * angle + from_middle - half);
    const double to = std::min(angle, 0.5 * angle + from_middle + half);
    return turned_surface(std::move(segments), from, std::max(from, to));
  }

  /// The parts of a swept profile's ends in the ball's box, and the sides.
  template <class Swept>
  [[nodiscard]] PrimitiveSurface with_caps(PrimitiveSurface sides, const Swept& swept) const {
    std::vector<PrimitiveSurface> parts{std::move(sides)};
    const std::vector<ProfileSegment> segments = segments_of(swept.profile);
    const AlignedBox2d whole = bounds_of(segments);
    for (const ProfileCap& cap : caps_of(swept)) {
      const Vector3d arm = centre_ - cap.origin;
      if (std::abs(cap.normal.dot(arm)) > radius_) continue;
      const Vector2d middle(cap.x_axis.dot(arm), cap.y_axis.dot(arm));
      const Vector2d reach = Vector2d::Constant(radius_);
      const AlignedBox2d box = whole.intersection(AlignedBox2d(middle - reach, middle + reach));
      if (box.isEmpty()) continue;
      const double area = box.contains(whole) ? area_of(swept.profile) : area_within(segments, box);
      parts.push_back(cap_surface(cap, segments, box, area));
    }
    return joined(std::move(parts));
  }

  [[nodiscard]] PrimitiveSurface of_triangles(std::vector<Triangle> triangles) const {
    return surface_of(near(std::move(triangles), centre_, radius_));
  }

  Vector3d centre_;  ///< of a ball around the region
  double radius_;
};

}  // namespace

PrimitiveSurface make_cut_surface(const Primitive& primitive, const AlignedBox& region) {
  if (!(region.diagonal().stableNorm() > 0)) return {};
  PrimitiveSurface local = std::visit(CutSurface(primitive.pose, region), primitive.shape);
  return placed(std::move(local), primitive.pose);
}

}  // namespace cloud2csg
