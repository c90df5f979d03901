#pragma once

#include <span>

#include "cells/crossings.hpp"

/// What is known to be empty, since sensors saw through it.
namespace cloud2csg {

/// Places on a line of sight; they fill a byte of a BlockMask.
inline constexpr std::size_t k_places_a_line = 8;

/// Lines from sensors to points on a primitive.
struct SightLines {
  PointCloud places =
      {};  ///< k_places_a_line of a line, evenly along it within the bounds of the cloud; neighbours first
  std::size_t count = 0;   ///< lines
  double points_each = 0;  ///< for how many points of the cloud a line stands
};

/// At most CellOptions::sight_lines of them, to points all over the cloud; none where it has no sensor positions.
/// Points on no primitive, outliers among them, are left out. `order`: see spatial_order(). O(lines x primitives)
[[nodiscard]] SightLines find_sight_lines(const PointCloud& cloud, std::span<const std::uint32_t> order,
                                          const ReachingPrimitives& reaching, const CellOptions& options,
                                          const RunContext& run);

}  // namespace cloud2csg
