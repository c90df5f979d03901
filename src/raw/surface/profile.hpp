#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "cloud2csg/advanced/surface.hpp"

namespace cloud2csg {

/// A point in the cylindrical coordinates of a surface of revolution.
struct AxialPoint {
  double height;            ///< along the axis, from the surface's position
  double radial;            ///< distance from the axis
  Eigen::Vector3d outward;  ///< unit length, from the axis to the point; arbitrary across the axis for a point on it
};

/// Precondition: `axis` of unit length.
[[nodiscard]] inline AxialPoint axial_point(const Eigen::Vector3d& position, const Eigen::Vector3d& axis,
                                            const Eigen::Vector3d& point) {
  constexpr double k_on_axis = 1e-13;
  const Eigen::Vector3d offset = point - position;
  const double height = axis.dot(offset);
  const Eigen::Vector3d across = offset - height * axis;
  const double radial = across.norm();
  // Within rounding of the axis, the remainder has an arbitrary direction, not one across the axis.
  const bool is_on_axis = radial <= k_on_axis * std::abs(height);
  return {height, radial, radial > 0 && !is_on_axis ? Eigen::Vector3d(across / radial) : axis.unitOrthogonal()};
}

/// Distance in the half plane of (radial, height) and its derivatives.
struct ProfileDistance {
  double distance;
  double by_radial, by_height;
};

/// Distance from a circle of radius `minor_radius` whose centre is `radius` from the axis. A radius of 0 makes a
/// sphere.
[[nodiscard]] inline ProfileDistance circle_profile(double radius, double minor_radius, const AxialPoint& point) {
  const double across = point.radial - radius;
  const double length = std::sqrt(across * across + point.height * point.height);
  if (length == 0) return {-minor_radius, 1, 0};
  return {length - minor_radius, across / length, point.height / length};
}

}  // namespace cloud2csg
