#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

/// A surface leaves a plane that is fitted to it by so much: as many times the noise...
constexpr double k_noise_tolerance = 3.0;
/// ...and as much of the distance: a sphere ten times as large as the neighbourhood does.
constexpr double k_bend_tolerance = 0.05;

/// A plane through the surface near a point.
struct LocalPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length, either way round
  double offset = 0.0;                                ///< of the point from the plane, along the normal
  double deviation = 0.0;                             ///< root mean square of the neighbours that the plane explains
  double support = 0.0;                               ///< share of the neighbours that it explains
};

/// A plane through points[point], fitted to it and its neighbours such that those farther than `tolerance` from it
/// do not bend it: near an edge it follows the face that the point is on. With fewer than 3 neighbours any plane.
/// The same for any order of calls. O(neighbours)
[[nodiscard]] LocalPlane fit_local_plane(const Points& points, std::size_t point,
                                         std::span<const std::uint32_t> neighbours, double tolerance);

/// The planes of all points of a cloud, with what they were fitted to: cleaning and normals both live off these.
struct LocalFits {
  /// Of each entry, its point in the cloud: entries that follow each other are near each other in space and memory.
  std::vector<std::uint32_t> order;
  Points points;  ///< in this order, relative to `centre`, as all that follows
  Eigen::Vector3d centre;
  NeighbourTable neighbours;
  std::vector<LocalPlane> planes;
};

/// Planes of `width` neighbours each. O(n width log n) @throws Cancelled
[[nodiscard]] LocalFits fit_locally(const PointCloud& cloud, std::size_t width, double noise, const RunContext& run,
                                    const StageShare& share);

/// How many neighbours a plane needs for its normal to be right to about three degrees.
[[nodiscard]] std::size_t plane_neighbours(const Scale& scale);

/// Robust standard deviation of points around a quadric over their best plane, made up for the six parameters.
/// Precondition: at least 12 points. O(points)
[[nodiscard]] double quadric_deviation(const Points& points, std::span<const std::uint32_t> indices);

}  // namespace cloud2csg
