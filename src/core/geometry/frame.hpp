#pragma once

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/point_cloud.hpp"

/// Work near the origin: far from it, doubles are too coarse for sums of products of coordinates.
namespace cloud2csg {

/// The middle of the points' bounds, rounded to multiples of a power of two above their diagonal. So a cloud about the
/// origin stays where it is, and one that is farther away moves there and back without rounding errors. Zero without
/// points, or when some are not finite. O(n)
[[nodiscard]] Eigen::Vector3d frame_origin(const Points& points);

/// The cloud as seen from another origin. O(n)
[[nodiscard]] PointCloud seen_from(PointCloud cloud, const Eigen::Vector3d& origin);

}  // namespace cloud2csg
