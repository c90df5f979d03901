#pragma once

#include <span>
#include <string>
#include <vector>

#include "cloud2csg/advanced/solids.hpp"

/// What the user knows of the part: radii and directions of surfaces, and whole solids.
namespace cloud2csg {

/// Surfaces with the radii and directions that they are known to have.
struct GivenSurfaces {
  std::vector<DetectedSurface> surfaces = {};  ///< as many as there were, in the same order
  std::vector<FixedValues> fixed = {};         ///< what of each was given, one each
  std::vector<Snap> snaps = {};
  std::vector<std::string> warnings = {};  ///< sentences for the user: what the points do not bear out
};

/// Gives surfaces the nearest of the given radii and directions that their points bear out: see RegularityOptions. A
/// surface that is changed is moved to where it suits its points best, and its rms is measured anew. O(points)
[[nodiscard]] GivenSurfaces take_given_values(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                              const RegularityOptions& options, double tolerance);

/// The surfaces without ends that known solids have, each with those of the solid's points that are nearest to it;
/// those without points are left out. Free forms (displaced solids, expressions) have none. O(points x faces).
[[nodiscard]] std::vector<DetectedSurface> surfaces_of_known(const PointCloud& cloud,
                                                             std::span<const KnownSolid> known);

}  // namespace cloud2csg
