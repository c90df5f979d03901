#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

/// A side that the sensor never saw, such as the one on which the part stood.
struct UnseenSide {
  Eigen::Vector3d normal;  ///< out of the solid
  double share;            ///< share in the whole surface, this side included
  PointCloud points;       ///< on the side's plane, as dense as the cloud, with its normal
  /// The same for flat undersides of overhangs, each at the height at which the walls around it end.
  std::vector<PointCloud> undersides = {};
};

/// Looks for a side without points. On a closed surface the area-weighted normals sum to zero, so their sum points
/// roughly away from a missing side. Among the directions of planes and axes near the sum (or the sum itself), takes
/// the one whose layers show a missing one best: along it, up- and down-facing areas balance, except for one more up
/// over the side. Directions nearly alike show the same; the one with most points just above the side counts. The side
/// is at the lowest points, but not where lines of sight pass below all that faces up, nor behind walls that end at one
/// height above it, as a sensor would have seen them go on. Absent if little is missing, if
/// there are scattered holes rather than a side, if a sensor was on that side, or if the cloud is a sheet that encloses
/// nothing. If the cloud has sensor positions, each new point gets one straight in front of it. Needs outward normals
/// and the area around each point, by point_areas(). O(points x surfaces) @throws Cancelled
[[nodiscard]] std::optional<UnseenSide> find_unseen_side(const PointCloud& cloud, std::span<const double> areas,
                                                         std::span<const DetectedSurface> surfaces, const Scale& scale,
                                                         const RunContext& run = {});

}  // namespace cloud2csg
