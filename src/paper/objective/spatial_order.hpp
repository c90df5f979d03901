#pragma once

#include <cstdint>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// From so many primitives on, a block of neighbouring points is near few of them, and it pays to find out of which.
inline constexpr std::size_t k_many_primitives = 32;

/// The indices of all points along a space-filling curve (Morton's) through `box`, which holds them: neighbours in this
/// order are near each other. Cells are cubes, at most 1024 along the longest side; within one, points stay in their
/// order. O(n). Does not depend on the number of threads.
[[nodiscard]] std::vector<std::uint32_t> spatial_order(PointsView positions, const AlignedBox& box,
                                                       const RunContext& run = {});

}  // namespace cloud2csg
