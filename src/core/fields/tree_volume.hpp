#pragma once

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// A volume by samples, with its standard error.
struct VolumeEstimate {
  double volume = 0;
  double error = 0;
};

/// The volume of a solid's part in `box`, by its implicit value. Octree cells wholly in or out count as they are. Cells
/// at the surface are divided to `2^levels` a side, and two random points judge each. Where a primitive is an
/// expression, nothing is known between points, and all cells are judged (`2^min(levels, 6)` a side). O(surface cells x
/// size). Independent of the number of threads. This estimate knows its own error. compare() cuts two solids by the
/// same columns, so that their common part is exact to the columns; measure_volumes() counts places by cell of the
/// arrangement.
/// @throws Cancelled
[[nodiscard]] VolumeEstimate tree_volume(const Model& model, const AlignedBox& box, int levels, const RunContext& run);

}  // namespace cloud2csg
