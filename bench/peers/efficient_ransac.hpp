#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"

namespace cloud2csg::bench {

struct RansacOptions {
  double tolerance = 3;           ///< CGAL's epsilon, in standard deviations of the noise
  std::size_t least_points = 15;  ///< in a surface
};

/// Surfaces by CGAL's Efficient RANSAC (Schnabel, Wahl and Klein 2007), with its tolerance of normals and its
/// probability of missing a surface as they are. Points are linked within four spacings.
[[nodiscard]] std::vector<DetectedSurface> detect_by_ransac(const PreparedCloud& prepared,
                                                            const RansacOptions& options);

}  // namespace cloud2csg::bench
