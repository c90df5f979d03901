#pragma once

#include <optional>
#include <span>

#include "cloud2csg/advanced/detect.hpp"

namespace cloud2csg {

/// A side that the sensor never saw, as that on which the part stood.
struct UnseenSide {
  Eigen::Vector3d normal;  ///< out of the solid
  double share;            ///< of the whole surface, with this side
  PointCloud points;       ///< on its plane, as dense as the cloud, with that normal
};

/// Looks for one. Over a closed surface the normals, weighted with area, sum up to nothing: what is left of the sum
/// faces roughly away from the side that is missing. Of the directions of planes and axes near it (its own where there
/// are none) that is taken along which the layers of the surface show best one that is missing: seen along it, as many
/// areas face up as down where nothing is missing, and one more up where the side is. The side lies as low as the
/// points reach. Absent when little is missing, when holes here and there are rather than one side, when a sensor was
/// on that side, and when the cloud is a sheet that encloses nothing. Where the cloud has sensor positions, so have the
/// new points: straight in front of them. O(points x surfaces + n log n) Precondition: the cloud has outward normals.
/// @throws Cancelled
[[nodiscard]] std::optional<UnseenSide> find_unseen_side(const PointCloud& cloud,
                                                         std::span<const DetectedSurface> surfaces, const Scale& scale,
                                                         const RunContext& run = {});

}  // namespace cloud2csg
