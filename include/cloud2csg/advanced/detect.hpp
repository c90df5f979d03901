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

/// Detection: the surfaces that a cloud lies on.
namespace cloud2csg {

/// Its fields: see the table.
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
        "How far points may be from their surface, in the cloud's units. So the facets of a coarse mesh count as the "
        "round surface that they stand for.",
        above(0),
        {.absent = "3 x the measured noise, at least 0.15 % of the diagonal", .unit = "D", .option = "tolerance"});
  field(&O::angle_tolerance_deg, "angle_tolerance_deg",
        "How many degrees the normals of points may be turned from the surface's. Generous: estimated normals are off "
        "by 10 degrees, and those of facets by 6.",
        above_to(0, 90), {.unit = "DEG", .option = "normal-tolerance"});
  field(&O::least_points, "least_points", "Surfaces with fewer points are left alone", at_least(1),
        {.absent = "one in 2000 of the cloud's, at least 30"});
  field(&O::least_size, "least_size",
        "Surfaces with a smaller radius, or whose points reach less far, are left out. In the cloud's units: the "
        "radius of a sphere or cylinder, both radii of a torus, and the diagonal of the box around the largest piece "
        "of its points. Points of those that are left out lie on no surface; but what is only round by a radius above "
        "`most_size` may be found to be flat.",
        above(0), {.absent = "no limit", .unit = "D", .option = "min-size"});
  field(&O::most_size, "most_size", "Surfaces with a larger radius, or that reach farther, are left out", above(0),
        {.absent = "no limit", .unit = "D", .option = "max-size"});
  field(&O::seed, k_inner_seed);
}
/// A least_size above most_size.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const DetectOptions& options);

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
