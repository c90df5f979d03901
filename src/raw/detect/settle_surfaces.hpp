#pragma once

#include <vector>

#include "cloud2csg/run_context.hpp"
#include "raw/detect/grow.hpp"

namespace cloud2csg {

/// Joins equal surfaces (a face in several pieces, a shaft through a wall). Drops those that others explain or that
/// have too few points. Each point goes to one agreeing surface, which is fitted to it: see share_points().
/// O(points x surfaces) @throws Cancelled
[[nodiscard]] std::vector<GrownSurface> settle_surfaces(std::vector<GrownSurface> surfaces, WorkCloud& cloud,
                                                        const NeighbourTable& neighbours, const SearchLimits& limits,
                                                        const RunContext& run);

}  // namespace cloud2csg
