#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {

/// One random place in each of about `count` cells, which divide a box evenly.
struct LatticePlaces {
  AlignedBox box;
  Eigen::Vector3i cells;  ///< along the axes; z varies fastest
  Points places;          ///< by cell

  /// The cell with a place in the box. O(1)
  [[nodiscard]] std::size_t cell_at(const Eigen::Vector3d& place) const;
  /// The shortest edge of a cell.
  [[nodiscard]] double least_edge() const { return box.sizes().cwiseQuotient(cells.cast<double>()).minCoeff(); }
};

/// Precondition: the box has a volume. O(count)
[[nodiscard]] LatticePlaces stratified(const AlignedBox& box, std::size_t count, RandomStream random);

/// Lines of sight through a cell.
struct SeenCell {
  std::uint32_t lines = 0;
  Eigen::Vector3d place;  ///< on one of the lines, near the cell's place
  double distance = 0;    ///< from the cell's place
};

/// By cell: the lines from sensors to these points, as far as they are at least `clear` away from their points. No
/// cells without sensor positions. Precondition: the points are in the box. O(points x cells along a line)
[[nodiscard]] std::vector<SeenCell> seen_cells(const LatticePlaces& lattice, const PointCloud& cloud,
                                               std::span<const std::uint32_t> points, double clear);

}  // namespace cloud2csg
