#pragma once

#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

/// The inside of a bent pipe that few or no sensors saw.
struct HiddenBend {
  DetectedSurface inside;  ///< a concave torus with the cloud's points on it, as exact as the outside
  PointCloud hidden = {};  ///< spread over the rest of it, with normals and sensor positions
};

/// Bends whose outside was seen and into whose inside a bore leads: a concave cylinder along the tangent at an end of
/// the bend, or a concave torus around the same circle, which was seen only in part. The pipe's wall is taken to be as
/// thick all along the bend. None without sensor positions. O(points x bends) @throws Cancelled
[[nodiscard]] std::vector<HiddenBend> find_hidden_bends(const PointCloud& cloud,
                                                        const std::vector<DetectedSurface>& surfaces,
                                                        const Scale& scale, const RunContext& run = {});

}  // namespace cloud2csg
