#pragma once

#include <cstddef>
#include <span>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

/// Of the surfaces that were found, those whose points are not on the solid.
struct UnusedSurfaces {
  std::size_t count = 0;
  std::size_t largest = 0;  ///< index of the one with the most points; no meaning where there are none
};

/// Unused: more than half of its points are farther than `near` from the surface of the solid. Those with fewer points
/// than `least_points` are passed over. O(surfaces x size)
[[nodiscard]] UnusedSurfaces find_unused_surfaces(const CsgTree& tree, const PrimitiveSet& solids,
                                                  const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                                  double near, std::size_t least_points);

}  // namespace cloud2csg
