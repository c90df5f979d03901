#pragma once

#include "cloud2csg/run_context.hpp"
#include "raw/detect/work_cloud.hpp"

namespace cloud2csg {

/// The free points that lie together and the taken points beside them, with normals estimated among these alone. In a
/// band between two faces that is a few points wide, the other normals follow the faces; the taken points are those of
/// its edges. `index` refers to the points of the whole cloud. `noise` is the standard deviation of the points, and
/// `neighbours` are those in the whole cloud. O(n log n) @throws Cancelled
[[nodiscard]] WorkCloud unexplained_part(const FreePoints& points, const NeighbourTable& neighbours, double noise,
                                         const RunContext& run);

}  // namespace cloud2csg
