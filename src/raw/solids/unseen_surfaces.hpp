#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/point_cloud.hpp"

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

/// What of the walls of bores and cups no sensor could see.
struct HiddenWall {
  std::size_t surface = 0;  ///< index into the surfaces
  PointCloud points = {};   ///< spread over it, with normals and sensor positions
  double area = 0;
};

/// Of concave cylinders and cones, the places that no sensor could see, on lines along the axis on which the wall was
/// seen, no farther out or in than where it was, or than a floor or ceiling across the axis that was seen; of concave
/// spheres all such places. None where sensors could see much of what has no points: there the wall has a gap. Without
/// them the space inside of a long bore, of which only the mouths are seen, would be taken for material.
/// None where the cloud has no sensor positions. O(points x surfaces + cells x sensors)
[[nodiscard]] std::vector<HiddenWall> find_hidden_walls(const PointCloud& cloud,
                                                        std::span<const DetectedSurface> surfaces, const Scale& scale,
                                                        const RunContext& run = {});

}  // namespace cloud2csg
