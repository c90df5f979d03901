#pragma once

#include <optional>

#include "cloud2csg/extract.hpp"

/// Where the result of a reconstruction and its points do not cover each other.
namespace cloud2csg {

/// The part of a solid's surface that no point of its cloud is near.
struct BareSurface {
  double share = 0;                                  ///< share of the solid's surface within the bounds of the cloud
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< the place on it farthest from all points
};

/// Estimated from deterministic samples; absent without samples on the surface. Precondition: the statistics have a
/// finding. O(points log points + samples x size). @throws Cancelled
[[nodiscard]] std::optional<BareSurface> find_bare_surface(const Extraction& result, const RunContext& run);

/// Detected surfaces whose points are not on the solid, since a part may be too small to be worth a leaf.
struct UnusedSurfaces {
  std::size_t count = 0;
  std::size_t largest = 0;  ///< index of the surface with the most points; meaningless for count 0
};

/// Counts surfaces that have most of their points farther from the result than twice the tolerance. Skips those with
/// fewer than one point in 200. Precondition: the statistics have a finding. O(surfaces x size)
[[nodiscard]] UnusedSurfaces find_unused_surfaces(const Extraction& result);

}  // namespace cloud2csg
