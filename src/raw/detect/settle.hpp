#pragma once

#include <vector>

#include "cloud2csg/run_context.hpp"
#include "raw/detect/grow.hpp"

namespace cloud2csg {

/// Looks at all surfaces together: those that are one are made one (a face in several pieces, a shaft through a wall);
/// each point of the cloud goes to the surface that it is nearest to, of those that it agrees with; those that others
/// explain, or that are left with too few points, go; each is fitted to all of its points.
/// O(points x surfaces)
[[nodiscard]] std::vector<GrownSurface> settle_surfaces(std::vector<GrownSurface> surfaces, const WorkCloud& cloud,
                                                        const SearchLimits& limits, const RunContext& run);

}  // namespace cloud2csg
