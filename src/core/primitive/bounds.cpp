#include <cassert>
#include <cmath>
#include <limits>

#include "cloud2csg/primitive.hpp"
#include "core/geometry/boxes.hpp"
#include "core/primitive/displaced_bounds.hpp"
#include "core/primitive/overloaded.hpp"
#include "core/primitive/polytope.hpp"

namespace cloud2csg {
namespace {

AlignedBox centred_box(const Eigen::Vector3d& half_size) {
  return {-half_size, half_size};
}

AlignedBox box_of_corners(const Polytope& polytope, const Pose& pose) {
  AlignedBox box;
  for (const Eigen::Vector3d& corner : corners(polytope)) box.extend(pose.to_world(corner));
  return box;
}

/// Half the extent, along each axis of the world, of a disk whose unit normal is `axis`.
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

/// The bounds of the undisplaced shape, in the world.
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
                               [&](const Expression& expression) { return enclosing(expression.bounds); }},
                    shape);
}

/// Bounds of where the undisplaced distance is at most so much.
AlignedBox reach_of_shape(const Shape& shape, const Pose& pose, double distance) {
  if (std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<Expression>(shape)) return everywhere();
  // Outside, near edges and corners, its distance is below the Euclidean one.
  if (const auto* polytope = std::get_if<Polytope>(&shape)) return box_of_corners(grown(*polytope, distance), pose);
  return grown(shape_bounds(shape, pose), distance);
}

/// The most that a displacement adds to a distance or takes from it.
constexpr double k_amplitude = 1.0;

}  // namespace

AlignedBox bounds(const Primitive& primitive) {
  // The bounds of an expression are its author's word on the displaced solid.
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

}  // namespace cloud2csg
