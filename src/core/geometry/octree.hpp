#pragma once

#include "cloud2csg/geometry.hpp"

namespace cloud2csg {

/// Cells of equal size, for searches that divide undecided cells.
struct OctreeLevel {
  Points centres;
  Eigen::Vector3d half_size;

  /// Distance from a cell's centre to its corners.
  [[nodiscard]] double radius() const { return half_size.norm(); }
  [[nodiscard]] double volume() const { return 8 * half_size.prod(); }
};

/// The box cut into `counts` cells along the axes; z varies fastest.
[[nodiscard]] OctreeLevel lattice(const AlignedBox& box, const Eigen::Vector3i& counts);

/// Each cell cut in two along the axis, its halves one after the other.
[[nodiscard]] OctreeLevel halved(const OctreeLevel& cells, int axis);
/// Each cell cut in eight; x varies fastest.
[[nodiscard]] OctreeLevel octants(const OctreeLevel& cells);

}  // namespace cloud2csg
