#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/primitive.hpp"

/// Segmentation: which points lie on the surface of which primitive.
namespace cloud2csg {

/// Its fields: see the table.
struct SegmentationOptions {
  std::optional<double> distance_tolerance = {};
  double angle_tolerance_deg = 30.0;
};
void option_table(OptionsOf<SegmentationOptions>, auto&& field) {
  using O = SegmentationOptions;
  field(&O::distance_tolerance, "distance_tolerance",
        "Points nearer than this to a primitive's surface belong to it, in the cloud's units. Three sigmas keep 99.7 % "
        "of the points of a Gaussian scan.",
        above(0), {.absent = "3 x the measured noise", .unit = "D"});
  field(&O::angle_tolerance_deg, "angle_tolerance_deg",
        "Their normal is within so many degrees of the surface's, whichever way round. A subtracted solid "
        "shows its surface from inside. Generous, because the surface's normal is taken at the noisy point.",
        above_to(0, 90), {.unit = "DEG"});
}

/// The standard deviation of the points' distances from the primitives, robust: 1.4826 times the median distance to the
/// nearest primitive whose normal agrees, over a subsample of at most 4096 points, taken again without the points that
/// are five times as far. Never below 1e-5 of the cloud's diagonal, so that a perfect cloud has a usable scale, and
/// never above a tenth of it, so that a cloud that lies elsewhere is not taken for a noisy one. O(primitives).
/// Precondition: the cloud has normals.
[[nodiscard]] double estimate_noise(const PointCloud& cloud, const PrimitiveSet& primitives,
                                    double angle_tolerance_deg = SegmentationOptions{}.angle_tolerance_deg,
                                    const RunContext& run = {});

/// The tolerances in force: options with what was absent filled in from the measured noise.
struct SegmentationTolerances {
  double distance = 0;
  double cosine = 0;  ///< of the angle
};
[[nodiscard]] SegmentationTolerances segmentation_tolerances(const SegmentationOptions& options, double noise);

/// A point belongs to every primitive that it is near enough to; to none when it is near none.
struct Segmentation {
  std::vector<std::vector<std::uint32_t>> points_of;  ///< point indices, ascending, by primitive
  std::size_t unassigned = 0;                         ///< points that belong to no primitive
};

/// O(points x primitives). The reference for the fused pass of build_rank_classes(), and the way to look at a
/// segmentation on its own. Precondition: the cloud has normals.
[[nodiscard]] Segmentation segment_points(const PointCloud& cloud, const PrimitiveSet& primitives,
                                          const SegmentationTolerances& tolerances, const RunContext& run = {});

/// The points that lie on a primitive's surface and are nearer to no other's.
struct SurfacePoints {
  std::vector<std::uint32_t> points;  ///< indices, ascending
  double rms = 0;                     ///< of their distances from the surface; 0 where there are none
};

/// Deals the points out to the primitives, one entry each: a point is near enough to a primitive as in a segmentation,
/// but belongs to the nearest only, of equally near ones to the first. Where a field is no distance (expressions,
/// displaced solids), the distance is its value over its slope. O(points x primitives).
/// Precondition: the cloud has normals. @throws Cancelled
[[nodiscard]] std::vector<SurfacePoints> deal_points(const PointCloud& cloud, const PrimitiveSet& primitives,
                                                     const SegmentationTolerances& tolerances,
                                                     const RunContext& run = {});

}  // namespace cloud2csg
