#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/run_context.hpp"
#include "core/base/run.hpp"
#include "core/geometry/neighbour_tree.hpp"

namespace cloud2csg {

/// Points a task in parallel loops.
constexpr std::size_t k_chunk_points = 512;

/// Points relative to the middle of their box, to avoid cancellation in products of coordinates far from the origin.
struct CentredPoints {
  Points points;
  Eigen::Vector3d centre;
};
[[nodiscard]] CentredPoints centred(PointsView points);

/// A fixed number of nearest neighbours for each point, nearest first, without the point itself.
struct NeighbourTable {
  std::size_t width = 0;
  std::vector<std::uint32_t> indices;  ///< [point x width]
  std::vector<float> distances;        ///< same layout

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t point) const {
    return std::span(indices).subspan(point * width, width);
  }
  [[nodiscard]] std::span<const float> distances_of(std::size_t point) const {
    return std::span(distances).subspan(point * width, width);
  }
};

/// The table for all points. `width` must be less than the number of points. O(n k log n) @throws Cancelled
[[nodiscard]] NeighbourTable find_neighbours(const Points& points, const NeighbourTree& tree, std::size_t width,
                                             const RunContext& run, const StageShare& share = {});

}  // namespace cloud2csg
