#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/point_cloud.hpp"

/// What of the walls of bores and cups no sensor could see.
namespace cloud2csg {

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
