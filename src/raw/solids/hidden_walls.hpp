#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

struct HiddenWall {
  std::size_t surface = 0;  ///< index into the surfaces
  PointCloud points = {};   ///< spread over the hidden part of the wall, with normals and sensor positions
  double area = 0;
};

/// Places of concave cylinders and cones that no sensor could see, on lines along the axis where the wall was seen,
/// within its seen extent or up to a floor or ceiling across the axis. A bore that was seen all around goes on to where
/// the material around it ends, unless other points are in its way. All such places of concave spheres. None where the
/// seen points leave the rest of the wall uncertain, where sensors could see much of the bare wall, or where lines of
/// sight cross it: then it is a gap. Without these places, the inside of a long bore with only its mouths seen would
/// count as material. None without sensor positions. `seen_points`: so many of the cloud's first points were seen, and
/// the others were added. O(points + points of surfaces x surfaces + (cells + lines of sight) x walls)
[[nodiscard]] std::vector<HiddenWall> find_hidden_walls(const PointCloud& cloud,
                                                        std::span<const DetectedSurface> surfaces, const Scale& scale,
                                                        std::size_t seen_points, const RunContext& run = {});

}  // namespace cloud2csg
