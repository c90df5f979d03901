#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "cloud2csg/advanced/surface.hpp"
#include "cloud2csg/geometry.hpp"
#include "cloud2csg/point_cloud.hpp"

/// Clouds for bench_detection, with the true surface of each point.
namespace cloud2csg::bench {

/// What the points of the tested surfaces would be without these surfaces. The alternatives around a plane, a line and
/// a place have the mean and the variance of the tested points, so that only their shape differs.
enum class Alternative {
  one_plane,     ///< all on one plane
  around_plane,  ///< normally distributed around the middle plane of two parallel planes
  around_line,   ///< normally distributed around the axis of a cylinder
  around_place   ///< normally distributed around the centre of a sphere
};

/// The surfaces that must be found, and the alternative to them.
struct Question {
  std::vector<std::uint32_t> surfaces;  ///< indices of true surfaces; `one_plane`: the last one is a plane
  Alternative alternative = Alternative::one_plane;
};

constexpr std::uint32_t k_no_surface = std::numeric_limits<std::uint32_t>::max();

struct Scene {
  std::vector<Surface> surfaces;  ///< the true ones
  PointCloud cloud = {};          ///< without normals
  // By point of the cloud:
  std::vector<std::uint32_t> surface = {};  ///< true surface of the point; k_no_surface for outliers
  Points exact = {};                        ///< place on that surface
  std::vector<double> noise = {};           ///< standard deviation of each coordinate
  /// What the oracle sees: the first points of the cloud, before views were misaligned or vertices smoothed. Later
  /// points of the cloud are copies and outliers.
  Points aligned = {};
  /// Half of the distance between misaligned views.
  double misalignment = 0;
};

}  // namespace cloud2csg::bench
