#include <algorithm>
#include <cassert>
#include <cmath>

#include "cloud2csg/primitive.hpp"
#include "core/primitive/overloaded.hpp"

namespace cloud2csg {
namespace {

/// The point of a disk across local z that is farthest in `direction`; any where all are alike.
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
                 [&](const Expression&) -> Eigen::Vector3d { return Eigen::Vector3d::Zero(); }},
      primitive.shape));
}

}  // namespace cloud2csg
