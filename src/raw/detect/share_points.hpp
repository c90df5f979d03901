#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/run_context.hpp"
#include "raw/detect/grow.hpp"

namespace cloud2csg {

/// Gives each surface all agreeing points, whoever found them first: the true surface of a face gets all of it. Their
/// support is not measured. @returns the points' distances, by surface
std::vector<std::vector<double>> claim_all(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                           const AgreementLimits& limits, const RunContext& run);

/// Gives each point to one of the surfaces that it agrees with: to the one on which the point and its neighbours are
/// likeliest. By its own distance alone, two surfaces less than six standard deviations apart would each lose the
/// points on the other's side, and move apart. In an exact cloud, the own distance decides. Surfaces with fewer than
/// `least` points are dropped. O(points x surfaces) @throws Cancelled
[[nodiscard]] std::vector<GrownSurface> share_points(std::vector<GrownSurface> surfaces, const WorkCloud& cloud,
                                                     const NeighbourTable& neighbours, const AgreementLimits& limits,
                                                     std::size_t least, const RunContext& run);

}  // namespace cloud2csg
