#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/geometry.hpp"

namespace cloud2csg {

/// Angles about the frame's z axis, from -pi to pi, at which surfaces turned about it end. A surface ends on both sides
/// of each wide gap between its points. An end near a plane through the axis, or near the place where another bend goes
/// on, is exactly there. The first end is the one in whose gap the fewest points of other surfaces are.
/// `revolved`: surfaces about the axis, with points. O(points of revolved + ends x surfaces)
[[nodiscard]] std::vector<double> sector_ends(const Pose& frame, const Points& positions,
                                              std::vector<const DetectedSurface*> revolved,
                                              std::span<const DetectedSurface> surfaces, double tolerance);

}  // namespace cloud2csg
