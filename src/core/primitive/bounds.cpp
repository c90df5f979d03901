#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

#include "cloud2csg/primitive.hpp"
#include "core/geometry/boxes.hpp"
#include "core/geometry/octree.hpp"
#include "core/primitive/polytope.hpp"
#include "core/primitive/profile.hpp"
#include "core/primitive/shape.hpp"

namespace cloud2csg {
namespace {

/// How often the search halves a side of the start box: the smallest cells are 1/256 of it.
constexpr int k_levels = 8;
/// Cells that the search divides for one side of the bounds before it settles for a looser bound.
constexpr int k_cell_budget = 256;

struct Interval {
  double low, high;
};

Interval product(const Interval& a, const Interval& b) {
  const auto [low, high] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
  return {low, high};
}

Interval sine_range(double from, double to) {
  const auto has_turn_at = [&](double angle) {
    const double turns = std::ceil((from - angle) / (2 * std::numbers::pi));
    return angle + 2 * std::numbers::pi * turns <= to;
  };
  const auto [low, high] = std::minmax({std::sin(from), std::sin(to)});
  return {has_turn_at(-0.5 * std::numbers::pi) ? -1 : low, has_turn_at(0.5 * std::numbers::pi) ? 1 : high};
}

/// A part of the start box after `level` halvings. `reach` is how far it extends in the search's direction.
struct Cell {
  Eigen::Vector3d centre;
  int level;
  double reach;
  double least_distance;  ///< lower bound of the displaced solid's distance in the cell

  /// The farther first; among equals the cell that more likely holds a point of the solid.
  friend bool operator<(const Cell& a, const Cell& b) {
    return a.reach != b.reach ? a.reach < b.reach : a.least_distance > b.least_distance;
  }
};

class BoundsSearch {
 public:
  BoundsSearch(const Primitive& primitive, const AlignedBox& start)
      : undisplaced_(primitive),
        frequency_(primitive.displacement->frequency),
        spread_(primitive.pose.orientation.conjugate().toRotationMatrix().cwiseAbs()),
        start_(start) {
    undisplaced_.displacement.reset();
  }

  /// The largest coordinate of the solid along sign * axis, times the sign; -infinity when the solid is empty.
  [[nodiscard]] double farthest(int axis, double sign) const {
    std::priority_queue<Cell> cells;
    cells.push({start_.center(), 0, reach(start_.center(), 0, axis, sign), -1});
    for (int divided = 0; !cells.empty(); ++divided) {
      const Cell cell = cells.top();
      // No other cell reaches farther.
      if (cell.level == k_levels || divided == k_cell_budget) return cell.reach;
      cells.pop();
      for (const Cell& child : children(cell, axis, sign)) {
        if (child.least_distance <= 0) cells.push(child);
      }
    }
    return -std::numeric_limits<double>::infinity();
  }

 private:
  [[nodiscard]] Eigen::Vector3d half_size(int level) const { return std::ldexp(0.5, -level) * start_.sizes(); }

  [[nodiscard]] double reach(const Eigen::Vector3d& centre, int level, int axis, double sign) const {
    return sign * centre[axis] + half_size(level)[axis];
  }

  [[nodiscard]] std::vector<Cell> children(const Cell& cell, int axis, double sign) const {
    const int level = cell.level + 1;
    OctreeLevel parts{.centres = {}, .half_size = half_size(cell.level)};
    parts.centres.push_back(cell.centre);
    parts = octants(parts);
    const std::vector<double> distances = signed_distance(undisplaced_, parts.centres);
    std::vector<Cell> result;
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const Eigen::Vector3d centre = parts.centres[i];
      const double least = distances[i] - parts.radius() + least_displacement(centre, parts.half_size);
      result.push_back({centre, level, reach(centre, level, axis, sign), least});
    }
    return result;
  }

  /// The least product of sines in a box along the solid's axes around a cell of the world.
  [[nodiscard]] double least_displacement(const Eigen::Vector3d& centre, const Eigen::Vector3d& half) const {
    const Eigen::Vector3d angle = frequency_ * undisplaced_.pose.to_local(centre);
    const Eigen::Vector3d change = frequency_ * (spread_ * half);
    Interval range{1, 1};
    for (int axis = 0; axis < 3; ++axis) {
      range = product(range, sine_range(angle[axis] - change[axis], angle[axis] + change[axis]));
    }
    return range.low;
  }

  Primitive undisplaced_;
  double frequency_;
  Eigen::Matrix3d spread_;  ///< turns half sizes in the world into half sizes in the solid's frame
  AlignedBox start_;
};

/// Bounds of a displaced solid that lies within `start`, by branch and bound for each of the six sides. They always
/// enclose the solid. Each side is tight to a two-hundredth of `start`, or looser where the search would take too long.
/// Precondition: the undisplaced distance has the Lipschitz constant 1, as with every shape but an Expression.
AlignedBox displaced_bounds(const Primitive& primitive, const AlignedBox& start) {
  assert(primitive.displacement);
  const BoundsSearch search(primitive, start);
  AlignedBox result;
  for (int axis = 0; axis < 3; ++axis) {
    result.max()[axis] = search.farthest(axis, 1);
    result.min()[axis] = -search.farthest(axis, -1);
  }
  return result;
}

AlignedBox centred_box(const Eigen::Vector3d& half_size) {
  return {-half_size, half_size};
}

AlignedBox box_of_corners(const Polytope& polytope, const Pose& pose) {
  AlignedBox box;
  for (const Eigen::Vector3d& corner : corners(polytope)) box.extend(pose.to_world(corner));
  return box;
}

/// Half the extent of a disk with unit normal `axis`, along each axis of the world.
Eigen::Vector3d disk_extent(const Eigen::Vector3d& axis, double radius) {
  return radius * (1.0 - axis.array().square()).max(0.0).sqrt();
}

AlignedBox cone_bounds(const Cone& cone, const Pose& pose) {
  const Eigen::Vector3d axis = pose.orientation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d arm = 0.5 * cone.height * axis;
  const Eigen::Vector3d bottom = disk_extent(axis, cone.radius_bottom);
  const Eigen::Vector3d top = disk_extent(axis, cone.radius_top);
  AlignedBox box(pose.position - arm - bottom, pose.position - arm + bottom);
  return box.extend(pose.position + arm - top).extend(pose.position + arm + top);
}

AlignedBox extrusion_bounds(const Extrusion& extrusion, const Pose& pose) {
  const Eigen::Matrix3d to_local = pose.orientation.conjugate().toRotationMatrix();
  const double half = 0.5 * extrusion.height;
  AlignedBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = to_local.col(axis);
    const auto [low, high] = extent_along(extrusion.profile, direction.head<2>());
    const double thickness = half * std::abs(direction.z());
    box.min()[axis] = pose.position[axis] + low - thickness;
    box.max()[axis] = pose.position[axis] + high + thickness;
  }
  return box;
}

/// Least and greatest dot product of the direction with the unit vectors of a turn from +x by the angle.
std::pair<double, double> extent_of_turn(const Revolution& revolution, const Eigen::Vector2d& direction) {
  const double reach = direction.norm();
  if (is_full_turn(revolution)) return {-reach, reach};
  const double angle = turn_of(revolution);
  const Eigen::Vector2d start(1, 0);
  const Eigen::Vector2d end(std::cos(angle), std::sin(angle));
  return extent_along(segment_between(start, std::tan(angle / 4), end), direction);
}

/// A point of the profile at (r, z) reaches r t + z a along an axis of the world with cosine a to local z, where t is
/// the extent of the turn.
AlignedBox revolution_bounds(const Revolution& revolution, const Pose& pose) {
  const Eigen::Matrix3d to_local = pose.orientation.conjugate().toRotationMatrix();
  AlignedBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = to_local.col(axis);
    const auto [least, most] = extent_of_turn(revolution, direction.head<2>());
    box.max()[axis] = pose.position[axis] + extent_along(revolution.profile, {most, direction.z()}).second;
    box.min()[axis] = pose.position[axis] + extent_along(revolution.profile, {least, direction.z()}).first;
  }
  return box;
}

AlignedBox shape_bounds(const Shape& shape, const Pose& pose) {
  const auto enclosing = [&pose](const AlignedBox& local) {
    const Pose centre{.position = pose.to_world(local.center()), .orientation = pose.orientation};
    return enclosing_box({.pose = centre, .half_size = 0.5 * local.sizes()});
  };
  return std::visit(Overloaded{[&](const Box& box) { return enclosing(centred_box(0.5 * box.size)); },
                               [&](const Sphere& sphere) {
                                 const Eigen::Vector3d reach = Eigen::Vector3d::Constant(sphere.radius);
                                 return AlignedBox(pose.position - reach, pose.position + reach);
                               },
                               [&](const Cylinder& cylinder) {
                                 return cone_bounds({cylinder.radius, cylinder.radius, cylinder.height}, pose);
                               },
                               [&](const Cone& cone) { return cone_bounds(cone, pose); },
                               [&](const Torus& torus) {
                                 const Eigen::Vector3d axis = pose.orientation * Eigen::Vector3d::UnitZ();
                                 const Eigen::Vector3d reach =
                                     disk_extent(axis, torus.major_radius).array() + torus.minor_radius;
                                 return AlignedBox(pose.position - reach, pose.position + reach);
                               },
                               [&](const HalfSpace&) { return everywhere(); },
                               [&](const Polytope& polytope) { return box_of_corners(polytope, pose); },
                               [&](const Extrusion& extrusion) { return extrusion_bounds(extrusion, pose); },
                               [&](const Revolution& revolution) { return revolution_bounds(revolution, pose); },
                               [&](const Expression& expression) { return enclosing(expression.bounds); }},
                    shape);
}

/// Bounds of the region where the undisplaced distance is at most `distance`.
AlignedBox reach_of_shape(const Shape& shape, const Pose& pose, double distance) {
  if (std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<Expression>(shape)) return everywhere();
  // Outside, near edges and corners, a polytope's distance is below the Euclidean one.
  if (const auto* polytope = std::get_if<Polytope>(&shape)) return box_of_corners(grown(*polytope, distance), pose);
  return grown(shape_bounds(shape, pose), distance);
}

/// The largest change of a distance by a displacement.
constexpr double k_amplitude = 1.0;

/// The point of a disk across local z that is farthest in `direction`; any where all are equally far.
Eigen::Vector3d disk_support(double radius, double z, const Eigen::Vector3d& direction) {
  const double across = std::hypot(direction.x(), direction.y());
  if (across == 0) return {radius, 0, z};
  return {radius * direction.x() / across, radius * direction.y() / across, z};
}

Eigen::Vector3d farther(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& direction) {
  return direction.dot(a) >= direction.dot(b) ? a : b;
}

Eigen::Vector3d cone_support(const Cone& cone, const Eigen::Vector3d& direction) {
  return farther(disk_support(cone.radius_bottom, -0.5 * cone.height, direction),
                 disk_support(cone.radius_top, 0.5 * cone.height, direction), direction);
}

Eigen::Vector3d polytope_support(const Polytope& polytope, const Eigen::Vector3d& direction) {
  const std::vector<Eigen::Vector3d> points = corners(polytope);
  assert(!points.empty());
  return *std::ranges::max_element(points, {}, [&](const Eigen::Vector3d& p) { return direction.dot(p); });
}

}  // namespace

AlignedBox bounds(const Primitive& primitive) {
  // The bounds of an expression are its author's claim about the displaced solid.
  if (!primitive.displacement || std::holds_alternative<HalfSpace>(primitive.shape) ||
      std::holds_alternative<Expression>(primitive.shape)) {
    return shape_bounds(primitive.shape, primitive.pose);
  }
  return displaced_bounds(primitive, reach_of_shape(primitive.shape, primitive.pose, k_amplitude));
}

AlignedBox reach(const Primitive& primitive, double distance) {
  return reach_of_shape(primitive.shape, primitive.pose, distance + (primitive.displacement ? k_amplitude : 0.0));
}

OrientedBox oriented_bounds(const Primitive& primitive) {
  if (std::holds_alternative<HalfSpace>(primitive.shape)) {
    return {.pose = primitive.pose, .half_size = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())};
  }
  Primitive at_origin = primitive;
  at_origin.pose = {};
  const AlignedBox local = bounds(at_origin);
  return {.pose = {.position = primitive.pose.to_world(local.center()), .orientation = primitive.pose.orientation},
          .half_size = 0.5 * local.sizes()};
}

Eigen::Vector3d support(const Primitive& primitive, const Eigen::Vector3d& direction) {
  assert(is_convex(primitive) && !std::holds_alternative<HalfSpace>(primitive.shape));
  const Eigen::Vector3d local = primitive.pose.orientation.conjugate() * direction;
  return primitive.pose.to_world(std::visit(
      Overloaded{[&](const Box& box) -> Eigen::Vector3d {
                   return 0.5 * box.size.array() * (local.array() < 0).select(-Eigen::Array3d::Ones(), 1.0);
                 },
                 [&](const Sphere& sphere) -> Eigen::Vector3d { return sphere.radius * local.stableNormalized(); },
                 [&](const Cylinder& cylinder) {
                   return cone_support({cylinder.radius, cylinder.radius, cylinder.height}, local);
                 },
                 [&](const Cone& cone) { return cone_support(cone, local); },
                 [&](const Torus&) -> Eigen::Vector3d { return Eigen::Vector3d::Zero(); },
                 [&](const HalfSpace&) -> Eigen::Vector3d { return Eigen::Vector3d::Zero(); },
                 [&](const Polytope& polytope) { return polytope_support(polytope, local); },
                 [&](const Extrusion&) -> Eigen::Vector3d { return Eigen::Vector3d::Zero(); },
                 [&](const Revolution&) -> Eigen::Vector3d { return Eigen::Vector3d::Zero(); },
                 [&](const Expression&) -> Eigen::Vector3d { return Eigen::Vector3d::Zero(); }},
      primitive.shape));
}

}  // namespace cloud2csg
