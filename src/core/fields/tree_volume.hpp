#pragma once

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Volume by samples, with its standard error.
struct VolumeEstimate {
  double volume = 0;
  double error = 0;
};

/// The volume of the part of a solid that is in `box`, by its implicit value: cells of an octree that are wholly in or
/// out count as they are, of those at the surface `2^levels` to a side are left, and each is judged by two random
/// points. The same for any number of threads. O(surface cells x size); where a primitive is an expression, nothing is
/// known between points, and all cells are judged (`2^min(levels, 6)` to a side).
///
/// It knows its own error, and is coarse where that will do. Two others stay beside it: compare() cuts two solids or
/// meshes by the same columns, so that what is common to both is exact to the columns; measure_volumes() counts places
/// by cell of the arrangement, all cells at once.
/// @throws Cancelled
[[nodiscard]] VolumeEstimate tree_volume(const Model& model, const AlignedBox& box, int levels, const RunContext& run);

}  // namespace cloud2csg
