#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cloud2csg/point_cloud.hpp"
#include "raw/detect/oriented_point.hpp"

namespace cloud2csg {

/// A cloud made ready for sampling: moved to its middle, scaled to a diagonal of one, and sorted along a Z curve, so
/// that the cells of an octree are runs of points.
struct WorkCloud {
  std::vector<OrientedPoint> points;
  std::vector<std::uint32_t> code;   ///< of the place on the curve, ascending: k_levels bits an axis
  std::vector<std::uint32_t> index;  ///< of each point in the cloud that this was made of
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double diagonal = 1;

  static constexpr int k_levels = 10;

  [[nodiscard]] std::size_t size() const { return points.size(); }
  /// The points [first, last) that share a cell of the octree with point i, its edge 2^-level of the cloud's longest.
  /// O(log n). Precondition: 0 <= level <= k_levels.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> cell_of(std::uint32_t i, int level) const;
  /// The diagonal of the box around these points. O(n)
  [[nodiscard]] double extent_of(const std::vector<std::uint32_t>& indices) const;
  /// At most so many of these points, evenly along the list.
  [[nodiscard]] std::vector<OrientedPoint> some_of(const std::vector<std::uint32_t>& indices, std::size_t most) const;
};

/// O(n log n). Precondition: the cloud has normals and points.
[[nodiscard]] WorkCloud make_work_cloud(const PointCloud& cloud);

}  // namespace cloud2csg
