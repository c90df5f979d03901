#pragma once

#include <Eigen/Core>

#include "cloud2csg/advanced/surface.hpp"

namespace cloud2csg {

/// A point as a surface of revolution sees it: how far along the axis and how far from it, and in which direction.
struct AxialPoint {
  double height;            ///< along the axis, from the surface's position
  double radial;            ///< distance from the axis
  Eigen::Vector3d outward;  ///< unit length, from the axis to the point; any across the axis for a point on it
};

/// Precondition: `axis` of unit length.
[[nodiscard]] AxialPoint axial_point(const Eigen::Vector3d& position, const Eigen::Vector3d& axis,
                                     const Eigen::Vector3d& point);

/// Distance in the half plane of (radial, height), and its slopes there.
struct ProfileDistance {
  double distance;
  double by_radial, by_height;
};

/// Distance from a circle of radius `minor_radius` whose centre is `radius` from the axis.
[[nodiscard]] ProfileDistance torus_profile(double radius, double minor_radius, const AxialPoint& point);

}  // namespace cloud2csg
