#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raw/detect/oriented_point.hpp"

namespace cloud2csg {

/// Splits the points with these indices into groups that hang together: points belong together when they lie in the
/// same cube of this edge, or in cubes that touch. The largest group first. O(n log n)
[[nodiscard]] std::vector<std::vector<std::uint32_t>> connected_groups(std::span<const OrientedPoint> points,
                                                                       std::span<const std::uint32_t> indices,
                                                                       double edge);

}  // namespace cloud2csg
