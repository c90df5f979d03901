#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cloud2csg/advanced/scale.hpp"
#include "cloud2csg/advanced/surface.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

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
  /// How small and how large a surface may be, in the cloud's units: the radius of a sphere or cylinder, both radii of
  /// a torus, and the diagonal of the box around the largest piece of its points. Others are left out, and their points
  /// lie on no surface; but what is only round by a radius above the most may be found to be flat. Absent: no limit.
  std::optional<double> least_size = {};
  std::optional<double> most_size = {};
  std::uint64_t seed = 1;
};

/// @throws Error naming the field when an option is out of range, or least_size is above most_size.
void validate(const DetectOptions& options);

struct DetectedSurface {
  Surface surface;
  std::vector<std::uint32_t> points;  ///< that lie on it and are nearer to no other, ascending
  double rms = 0;                     ///< of their distances, in the cloud's units
  double turn_deg = 0;                ///< standard deviation of the axis in its worst direction, by these points
};

struct Detection {
  std::vector<DetectedSurface> surfaces;
  std::size_t unexplained = 0;    ///< points that lie on none
  double distance_tolerance = 0;  ///< the one in force
};

/// The tolerance in force: the option, or what it stands for when absent. In the cloud's units.
[[nodiscard]] double detection_tolerance(const DetectOptions& options, const Scale& scale);

/// The least number of points of a surface in a cloud of so many: the option, or what it stands for when absent.
[[nodiscard]] std::size_t detection_least_points(const DetectOptions& options, std::size_t points);

/// Finds planes, spheres, cylinders, cones and tori, convex and concave, by random samples of points that are near each
/// other, in the manner of Schnabel, Wahl, Klein: Efficient RANSAC for Point-Cloud Shape Detection (2007). The largest
/// surface is taken first, its points set aside, and so on; then all are looked at together. Faces in one plane are one
/// surface, so are pieces of one cylinder. Each surface has no ends: where it ends is for the solids to tell.
/// O(points x surfaces): 100 000 points take some tenths of a second. The result does not depend on the number of
/// threads or the units. Precondition: the cloud has normals and points. @throws Error as validate(); Cancelled
[[nodiscard]] Detection detect_surfaces(const PointCloud& cloud, const Scale& scale, const DetectOptions& options = {},
                                        const RunContext& run = {});

}  // namespace cloud2csg
