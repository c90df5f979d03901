#pragma once

#include "cloud2csg/geometry.hpp"

/// Searches of a region that halve what they cannot tell about.
namespace cloud2csg {

/// Boxes of equal size, side by side.
struct OctreeLevel {
  Points centres;
  Eigen::Vector3d half_size;

  /// From a centre to the corners.
  [[nodiscard]] double radius() const { return half_size.norm(); }
  /// Of one.
  [[nodiscard]] double volume() const { return 8 * half_size.prod(); }
};

/// The box in so many cells along each axis, z first.
[[nodiscard]] OctreeLevel lattice(const AlignedBox& box, const Eigen::Vector3i& counts);

/// Each cell in two along the axis, one after the other.
[[nodiscard]] OctreeLevel halved(const OctreeLevel& cells, int axis);
/// Each cell in eight, x first.
[[nodiscard]] OctreeLevel octants(const OctreeLevel& cells);

}  // namespace cloud2csg
