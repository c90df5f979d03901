#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/solids.hpp"

namespace cloud2csg {

/// The surfaces without ends that known solids have, each with those of the solid's points that are nearest to it;
/// those without points are left out. Free forms (displaced solids, expressions) have none. O(points x faces).
[[nodiscard]] std::vector<DetectedSurface> surfaces_of_known(const PointCloud& cloud,
                                                             std::span<const KnownSolid> known);

}  // namespace cloud2csg
