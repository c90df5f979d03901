#pragma once

#include <vector>

#include "cloud2csg/run_context.hpp"
#include "raw/detect/grow.hpp"
#include "raw/detect/unexplained.hpp"

namespace cloud2csg {

/// Surfaces, and the points that took the normals of new ones.
struct MixedSurfaces {
  std::vector<GrownSurface> surfaces;
  std::vector<OwnNormal> turned = {};
};

/// Replaces surfaces whose points lie among each other's, and the free points among these, by a plane, two parallel
/// planes, a cylinder or a sphere that explains their positions better. So does it with free points alone. In walls and
/// bores that are a few standard deviations of the noise wide, the estimated normals are arbitrary, and surfaces that
/// agree with them are wrong; or one takes both sides of a wall. The points take the normals of their new surfaces.
/// O(n surfaces), and O(n log n) if any is replaced @throws Cancelled
[[nodiscard]] MixedSurfaces replace_mixed_surfaces(std::vector<GrownSurface> surfaces, WorkCloud& cloud,
                                                   const NeighbourTable& neighbours, const SearchLimits& limits,
                                                   const RunContext& run);

}  // namespace cloud2csg
