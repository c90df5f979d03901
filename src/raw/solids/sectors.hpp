#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/geometry.hpp"

namespace cloud2csg {

/// Angles about the frame's z axis, from -pi to pi, at which surfaces turned about it end. A surface ends on both sides
/// of each wide gap between its points. An end next to a plane through the axis, or to the direction of another bend's
/// centre, is exactly there. The ends of the surface with the most points come first.
/// `revolved`: surfaces about the axis, with points. O(points of revolved + surfaces)
[[nodiscard]] std::vector<double> sector_ends(const Pose& frame, const Points& positions,
                                              std::vector<const DetectedSurface*> revolved,
                                              std::span<const DetectedSurface> surfaces, double tolerance);

}  // namespace cloud2csg
