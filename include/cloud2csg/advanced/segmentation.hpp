#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/primitive.hpp"

/// Segmentation: which points lie on the surface of which primitive.
namespace cloud2csg {

struct SegmentationOptions {
  std::optional<double> distance_tolerance = {};
  double angle_tolerance_deg = 30.0;
};
void option_table(OptionsOf<SegmentationOptions>, auto&& field) {
  using O = SegmentationOptions;
  field(&O::distance_tolerance, "distance_tolerance",
        "Distance below which points belong to a primitive, in the cloud's units. Three sigmas keep 99.7 % of the "
        "points of a Gaussian scan.",
        above(0), {.absent = "3 x the measured noise", .unit = "D"});
  field(&O::angle_tolerance_deg, "angle_tolerance_deg",
        "Largest angle between the normals of a point and of its primitive, in degrees, whatever their sign. A "
        "subtracted solid shows its surface from inside. Generous, because the primitive's normal is taken at the "
        "noisy point.",
        above_to(0, 90), {.unit = "DEG"});
}

/// Robust standard deviation of the points' distances from the primitives. It is 1.4826 times the median distance to
/// the nearest primitive with an agreeing normal, over at most 4096 sampled points, repeated without points five times
/// as far. It is at least 1e-5 of the cloud's diagonal, as a scale for perfect clouds, and at most a tenth of it, so
/// that a misplaced cloud does not pass for a noisy one. O(primitives). Precondition: the cloud has normals.
[[nodiscard]] double estimate_noise(const PointCloud& cloud, const PrimitiveSet& primitives,
                                    double angle_tolerance_deg = SegmentationOptions{}.angle_tolerance_deg,
                                    const RunContext& run = {});

/// The tolerances in force: the options, with defaults from the measured noise.
struct SegmentationTolerances {
  double distance = 0;
  double cosine = 0;  ///< cosine of the angle tolerance
};
[[nodiscard]] SegmentationTolerances segmentation_tolerances(const SegmentationOptions& options, double noise);

/// A point belongs to every primitive within the tolerances, maybe to none.
struct Segmentation {
  std::vector<std::vector<std::uint32_t>> points_of;  ///< point indices, ascending, by primitive
  std::size_t unassigned = 0;
};

/// Reference for the fused pass of build_rank_classes(). Precondition: the cloud has normals. O(points x primitives)
[[nodiscard]] Segmentation segment_points(const PointCloud& cloud, const PrimitiveSet& primitives,
                                          const SegmentationTolerances& tolerances, const RunContext& run = {});

/// The points that lie on a primitive's surface and are nearer to no other's.
struct SurfacePoints {
  std::vector<std::uint32_t> points;  ///< indices, ascending
  double rms = 0;                     ///< root mean square distance from the surface; 0 without points
};

/// Assigns points to primitives, with one result per primitive. A point within the tolerances belongs only to its
/// nearest primitive, the first of equally near ones. For expressions and displaced solids the distance is the field's
/// value over its slope. O(points x primitives). Precondition: the cloud has normals. @throws Cancelled
[[nodiscard]] std::vector<SurfacePoints> deal_points(const PointCloud& cloud, const PrimitiveSet& primitives,
                                                     const SegmentationTolerances& tolerances,
                                                     const RunContext& run = {});

}  // namespace cloud2csg
