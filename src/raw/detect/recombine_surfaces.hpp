#pragma once

#include <optional>
#include <vector>

#include "raw/detect/grow.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

/// Surfaces of which a better one replaces some: one, or one or both of two that touch. Better: it makes their points
/// likelier by more than its parameters cost (BIC). The search takes the surface with the most points first. With
/// noise, a sphere may take parts of two cones, and other surfaces the rest of them. Looks only at round surfaces that
/// most patches of their points are off, and at those beside them. Absent if none is better. Precondition: no point is
/// on two surfaces. O(n) and O(pairs that touch) @throws Cancelled
[[nodiscard]] std::optional<std::vector<GrownSurface>> recombined(std::vector<GrownSurface> surfaces,
                                                                  const WorkCloud& cloud,
                                                                  const NeighbourTable& neighbours,
                                                                  const SearchLimits& limits, const RunContext& run);

}  // namespace cloud2csg
