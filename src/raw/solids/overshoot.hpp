#pragma once

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/primitive.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Solids that overlap others in the tree instead of sharing a surface with them, which rounding would turn into thin
/// sheets and gaps. Segments of profiles, and sides of boxes and cylinders, lie up to a percent of the part's diagonal
/// farther out where that changes nothing: at points in the strip, the tree is the same with and without the solid.
/// Ends that share no surface stay. The first `fixed` solids stay, and those that are left when the run is stopped.
/// O(segments x solids x points)
[[nodiscard]] PrimitiveSet with_overshoots(PrimitiveSet solids, const CsgTree& tree, std::size_t fixed,
                                           const AlignedBox& part, const RunContext& run = {});

}  // namespace cloud2csg
