#pragma once

#include <Eigen/Core>

#include "cloud2csg/advanced/surface.hpp"

namespace cloud2csg {

/// A point in the cylindrical coordinates of a surface of revolution.
struct AxialPoint {
  double height;            ///< along the axis, from the surface's position
  double radial;            ///< distance from the axis
  Eigen::Vector3d outward;  ///< unit length, from the axis to the point; arbitrary across the axis for a point on it
};

/// Precondition: `axis` of unit length.
[[nodiscard]] AxialPoint axial_point(const Eigen::Vector3d& position, const Eigen::Vector3d& axis,
                                     const Eigen::Vector3d& point);

/// Distance in the half plane of (radial, height) and its derivatives.
struct ProfileDistance {
  double distance;
  double by_radial, by_height;
};

/// Distance from a circle of radius `minor_radius` whose centre is `radius` from the axis.
[[nodiscard]] ProfileDistance torus_profile(double radius, double minor_radius, const AxialPoint& point);

}  // namespace cloud2csg
