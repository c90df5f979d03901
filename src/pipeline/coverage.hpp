#pragma once

#include <cstddef>

#include "cloud2csg/extract.hpp"

/// Where the result of a reconstruction does not cover its points.
namespace cloud2csg {

/// Detected surfaces whose points are not on the solid, since a part may be too small to be worth a leaf.
struct UnusedSurfaces {
  std::size_t count = 0;
  std::size_t largest = 0;  ///< index of the surface with the most points; meaningless for count 0
};

/// Counts surfaces that have most of their points farther from the result than twice the tolerance. Skips those with
/// fewer than one point in 200. Precondition: the statistics have a finding. O(surfaces x size)
[[nodiscard]] UnusedSurfaces find_unused_surfaces(const Extraction& result);

}  // namespace cloud2csg
