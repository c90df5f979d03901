#pragma once

#include <optional>
#include <vector>

#include "raw/detect/grow.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

/// Replaces a wrong round surface, or it and one that it touches, by one better surface; or one of the two. Better: it
/// makes their points likelier by more than its parameters cost (BIC). The search takes the surface with the most
/// points first. With noise, a sphere may take parts of two cones, and other surfaces the rest of them. A surface is
/// wrong if patches of its points are off by clearly more than those on the best tenth of the points. Surfaces with a
/// form error, such as that of facets, stay. Absent if none is better. Precondition: no point is on two surfaces. O(n +
/// surfaces that are wrong x surfaces), and some fits for each pair that touches @throws Cancelled
[[nodiscard]] std::optional<std::vector<GrownSurface>> recombined(std::vector<GrownSurface> surfaces,
                                                                  const WorkCloud& cloud,
                                                                  const NeighbourTable& neighbours,
                                                                  const SearchLimits& limits, const RunContext& run);

}  // namespace cloud2csg
