#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"
#include "cloud2csg/scale.hpp"
#include "cloud2csg/surface.hpp"

/// Detection: the surfaces that a cloud lies on.
namespace cloud2csg {

struct DetectOptions {
  /// How far a point may be from its surface, in the cloud's units. Absent: three times the noise, and at least
  /// 0.15 % of the cloud's diagonal, so that the facets of a coarse mesh count as the round surface that they stand
  /// for.
  std::optional<double> distance_tolerance = {};
  /// ... and how far its normal may be turned from the surface's. Generous: estimated normals are off by 10 degrees,
  /// and those of facets by 6.
  double angle_tolerance_deg = 25.0;
  /// Surfaces with fewer points are left alone. Absent: one in 2000 of the cloud's, and at least 30.
  std::optional<std::size_t> least_points = {};
  std::uint64_t seed = 1;
};

struct DetectedSurface {
  Surface surface;
  std::vector<std::uint32_t> points;  ///< that lie on it and are nearer to no other, ascending
  double rms = 0;                     ///< of their distances, in the cloud's units
};

struct Detection {
  std::vector<DetectedSurface> surfaces;
  std::size_t unexplained = 0;    ///< points that lie on none
  double distance_tolerance = 0;  ///< the one in force
};

/// The tolerance in force: the option, or what it stands for when absent. In the cloud's units.
[[nodiscard]] double detection_tolerance(const DetectOptions& options, const Scale& scale);

/// Finds planes, spheres, cylinders, cones and tori, convex and concave, by random samples of points that are near each
/// other, in the manner of Schnabel, Wahl, Klein: Efficient RANSAC for Point-Cloud Shape Detection (2007). The largest
/// surface is taken first, its points set aside, and so on; then all are looked at together. Faces in one plane are one
/// surface, so are pieces of one cylinder. Each surface has no ends: where it ends is for the solids to tell.
/// O(points x surfaces): 100 000 points take some tenths of a second. The result does not depend on the number of
/// threads or the units. Precondition: the cloud has normals and points. @throws Cancelled
[[nodiscard]] Detection detect_surfaces(const PointCloud& cloud, const Scale& scale, const DetectOptions& options = {},
                                        const RunContext& run = {});

}  // namespace cloud2csg
