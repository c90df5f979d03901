#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

struct LocalPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length, arbitrary sign
  double offset = 0.0;                                ///< from the plane to the point, along the normal
  double deviation = 0.0;                             ///< root mean square over the inliers
  double support = 0.0;                               ///< share of the neighbours that are inliers
};

/// A plane through points[point], fitted to it and its neighbours. Neighbours farther than `tolerance` do not bend it:
/// near an edge it follows the point's own face. Arbitrary for fewer than 3 neighbours. Deterministic. O(neighbours)
[[nodiscard]] LocalPlane fit_local_plane(const Points& points, std::size_t point,
                                         std::span<const std::uint32_t> neighbours, double tolerance);

/// The same with a row of a table. The tolerance is that of the noise, or the share `bend` of the neighbourhood's
/// radius if that is larger, because curved surfaces leave their planes.
[[nodiscard]] LocalPlane fit_local_plane(const Points& points, std::size_t point, const NeighbourTable& neighbours,
                                         double noise, double bend);

/// The same for all points. O(n k) @throws Cancelled
[[nodiscard]] std::vector<LocalPlane> fit_local_planes(const Points& points, const NeighbourTable& neighbours,
                                                       double noise, double bend, const RunContext& run,
                                                       const StageShare& share = {});

/// The local planes of all points, shared by cleaning and normal estimation.
struct LocalFits {
  /// Original index of each entry. Consecutive entries are near each other in space and memory.
  std::vector<std::uint32_t> order;
  Points points;  ///< in this order and relative to `centre`, like the members below
  Eigen::Vector3d centre;
  NeighbourTable neighbours;
  std::vector<LocalPlane> planes;
};

/// Fits planes to `width` neighbours each. O(n width log n) @throws Cancelled
[[nodiscard]] LocalFits fit_locally(const PointCloud& cloud, std::size_t width, double noise, const RunContext& run,
                                    const StageShare& share);

/// Number of neighbours for a normal error of about three degrees.
[[nodiscard]] std::size_t plane_neighbours(const Scale& scale);

/// Robust standard deviation of points from a quadric over the plane of half of them, corrected for its six parameters.
/// Precondition: at least 12 points. O(points)
[[nodiscard]] double quadric_deviation(const Points& points, std::span<const std::uint32_t> indices);

}  // namespace cloud2csg
