#pragma once

#include <span>
#include <string>
#include <vector>

#include "cloud2csg/advanced/solids.hpp"

/// What the user knows about the part: radii and directions of surfaces, and whole solids.
namespace cloud2csg {

struct GivenSurfaces {
  std::vector<DetectedSurface> surfaces = {};  ///< as many as the input, in the same order
  std::vector<FixedValues> fixed = {};         ///< which values of each surface were given
  std::vector<Snap> snaps = {};
  std::vector<std::string> warnings = {};  ///< for the user: given values that the points contradict
};

/// Sets surfaces to the nearest given radii and directions that their points support: see RegularityOptions. Moves each
/// changed surface to fit its points best and updates its rms. O(points)
[[nodiscard]] GivenSurfaces take_given_values(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                              const RegularityOptions& options, double tolerance);

/// The unbounded surfaces of known solids, each with the nearest of the solid's points. Drops surfaces without points.
/// Free forms (displaced solids, expressions) have none. O(points x faces).
[[nodiscard]] std::vector<DetectedSurface> surfaces_of_known(const PointCloud& cloud,
                                                             std::span<const KnownSolid> known);

}  // namespace cloud2csg
