#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/advanced/surface.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

/// Detection of the surfaces in a cloud.
namespace cloud2csg {

struct DetectOptions {
  std::optional<double> distance_tolerance = {};
  double angle_tolerance_deg = 25.0;
  std::optional<std::size_t> least_points = {};
  std::optional<double> least_size = {}, most_size = {};
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<DetectOptions>, auto&& field) {
  using O = DetectOptions;
  field(&O::distance_tolerance, "distance_tolerance",
        "Largest distance of points from their surface, in the cloud's units. With the default, the facets of a coarse "
        "mesh count as the round surface that they approximate. A given value counts as three times the noise: nearer "
        "surfaces of one kind are one.",
        above(0),
        {.absent = "3 x the measured noise, at least 0.15 % of the diagonal", .unit = "D", .option = "tolerance"});
  field(&O::angle_tolerance_deg, "angle_tolerance_deg",
        "Largest angle between the normals of points and of their surface, in degrees. Generous: estimated normals are "
        "off by 10 degrees, and those of facets by 6.",
        above_to(0, 90), {.unit = "DEG", .option = "normal-tolerance"});
  field(
      &O::least_points, "least_points", "Ignore surfaces with fewer points", at_least(1),
      {.absent =
           "as many as cannot be chance: 10 (a plane) to 14 (a torus) in a sparse exact cloud, more the more spacings "
           "the tolerance has"});
  field(&O::least_size, "least_size",
        "Leave out surfaces with a smaller radius or extent, in the cloud's units. The radius is that of a sphere or "
        "cylinder, or that of a torus' tube; the extent is the diagonal of the box around the largest connected piece "
        "of the surface's points. Points of surfaces that are left out lie on no surface; but a surface whose only "
        "possible radius is above `most_size` may be detected as flat.",
        above(0), {.absent = "no limit", .unit = "D", .option = "min-size"});
  field(&O::most_size, "most_size",
        "Leave out surfaces with a larger radius (of a torus, either) or extent, in the cloud's units", above(0),
        {.absent = "no limit", .unit = "D", .option = "max-size"});
  field(&O::seed, k_inner_seed);
}
/// Refuses a least_size above most_size.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const DetectOptions& options);

struct DetectedSurface {
  Surface surface;
  std::vector<std::uint32_t> points;  ///< points on it that are nearer to no other, ascending
  double rms = 0;                     ///< root mean square distance of the points, in the cloud's units
  double turn_deg = 0;                ///< standard deviation of the axis in its worst direction, from these points
};

struct Detection {
  std::vector<DetectedSurface> surfaces;
  std::size_t unexplained = 0;
  /// Standard deviation of the points across the planes among the largest surfaces. That of the scale if there are
  /// none, or if a tolerance is given. In the cloud's units.
  double noise = 0;
  /// The option, or the default by this noise. Points of places that are clearly noisier may lie farther off.
  double distance_tolerance = 0;
  /// Points on no surface, beside edges that a smoothing of the cloud has rounded; ascending. None if a tolerance is
  /// given.
  std::vector<std::uint32_t> smoothed = {};
};

/// The distance tolerance: the option, or its default by the noise of the scale. In the cloud's units.
[[nodiscard]] double detection_tolerance(const DetectOptions& options, const Scale& scale);

/// Finds planes, spheres, cylinders, cones and tori, convex and concave, from random samples of neighbouring points, in
/// the manner of Schnabel, Wahl, Klein: Efficient RANSAC for Point-Cloud Shape Detection (2007). It takes the largest
/// surface first and sets its points aside, repeatedly, then settles all surfaces together. Coplanar faces are one
/// surface, and so are pieces of one cylinder. Surfaces are unbounded: choose_solids() finds their ends. O(points x
/// surfaces): 100 000 points take some tenths of a second. The result does not depend on the number of threads or the
/// units. Precondition: the cloud has normals and points. @throws Error as validate(); Cancelled
[[nodiscard]] Detection detect_surfaces(const PointCloud& cloud, const Scale& scale, const DetectOptions& options = {},
                                        const RunContext& run = {});

}  // namespace cloud2csg
