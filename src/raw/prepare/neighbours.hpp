#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/run_context.hpp"
#include "core/base/run.hpp"
#include "core/geometry/neighbour_tree.hpp"

namespace cloud2csg {

/// Points relative to the middle of their box, to avoid cancellation in products of coordinates far from the origin.
struct CentredPoints {
  Points points;
  Eigen::Vector3d centre;
};
[[nodiscard]] CentredPoints centred(PointsView points);

/// A fixed number of nearest neighbours for each of some points, nearest first, without the point itself.
struct NeighbourTable {
  std::size_t width = 0;
  std::vector<std::uint32_t> indices;  ///< [row x width]
  std::vector<float> distances;        ///< same layout

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t row) const {
    return std::span(indices).subspan(row * width, width);
  }
  /// The first `most` of the row.
  [[nodiscard]] std::span<const std::uint32_t> nearest(std::size_t row, std::size_t most) const {
    return of(row).first(std::min(most, width));
  }
  [[nodiscard]] std::span<const float> distances_of(std::size_t row) const {
    return std::span(distances).subspan(row * width, width);
  }
};

/// The table of all points, a row for each. Fewer points than `width` have narrower rows. O(n k log n) @throws
/// Cancelled
[[nodiscard]] NeighbourTable find_neighbours(const Points& points, const NeighbourTree& tree, std::size_t width,
                                             const RunContext& run, const StageShare& share = {});

/// Surface area at each point of a table, from the distance to its k_nearest-th neighbour, or the farthest of fewer.
/// O(n)
[[nodiscard]] std::vector<double> areas_of(const NeighbourTable& neighbours);

}  // namespace cloud2csg
