#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// How large, how dense and how noisy a cloud is, in its own units. Tolerances of later stages are multiples of these,
/// so that no result depends on the unit or on where the origin is.
struct Scale {
  AlignedBox box;         ///< of the points, stray ones left out
  double diagonal = 0.0;  ///< of the box
  /// Square root of the surface that a point stands for: the step of a square grid as dense as the cloud. For points
  /// drawn at random the nearest neighbour is, in the median, half as far.
  double spacing = 0.0;
  /// Standard deviation of the points from the surface along its normal; 0 for exact points on planes.
  double noise = 0.0;
};

/// Measures a cloud from a sample of its points. Noise is the deviation from local quadrics whose size follows the
/// noise; of the deviations in the denser half of the sample, where outliers are few, a low percentile is taken, so
/// that edges and details do not count as noise. Right to about a quarter for noise of up to 0.5 % of the diagonal, as
/// long as a third of the surface is smooth at five times the noise; at 1 % it may be 2.5 times too large on parts with
/// fine detail. With as many outliers as points it comes out up to twice as large. The same for any seed, unit and
/// origin. O(n log n)
/// @throws Error for fewer than 10 points, or points all in one place; Cancelled.
[[nodiscard]] Scale estimate_scale(const PointCloud& cloud, const RunContext& run = {});

/// Which points of a raw cloud are left out: see the table.
struct CleanOptions {
  bool remove_outliers = true;
  std::size_t point_budget = 500'000;
};
void option_table(OptionsOf<CleanOptions>, auto&& field) {
  using O = CleanOptions;
  field(&O::remove_outliers, "remove_outliers",
        "Leave out points that no surface goes through. It takes most of the time of the preparation.",
        {.opposite = "keep-outliers", .otherwise = "Do not look for outliers: the cloud is clean"});
  field(&O::point_budget, "point_budget",
        "More points than about so many are thinned. Beyond, later stages gain no accuracy, only take longer.",
        at_least(1));
}

/// How many points each step left out.
struct CleanReport {
  std::size_t duplicates = 0;   ///< at the very place of another one
  std::size_t isolated = 0;     ///< far from all others
  std::size_t off_surface = 0;  ///< near others, but on none of the planes that these form
  std::size_t thinned = 0;      ///< by down-sampling to the budget
};

struct CleanCloud {
  PointCloud cloud;  ///< points of the input in their order, with all that is known of them
  CleanReport report;
};

/// Leaves out repeated points, outliers, and more points than the budget. A point is an outlier when few of its
/// neighbours' local planes go through it (within three times the noise): so sparse regions, thin walls and edges stay.
/// Where the first pass finds many outliers, the next ones expect more of points that are far from others, and of
/// planes, as chance makes some, too. Of as many uniform outliers as points 94 % and more of those off the surface go,
/// and with them a few of the points where walls are thinner than some spacings. Thinning keeps one point a voxel; the
/// voxel is never wider than three spacings or four times the noise, so that the budget may be exceeded. O(n log n)
/// @throws Error for a budget of 0; Cancelled.
[[nodiscard]] CleanCloud clean_cloud(const PointCloud& cloud, const Scale& scale, const CleanOptions& options = {},
                                     const RunContext& run = {});

/// Normals made from positions, and how sure their orientation is.
struct EstimatedNormals {
  Points normals;            ///< unit length, out of the solid
  std::size_t bodies = 0;    ///< parts that no neighbours join; 0 with sensors
  std::size_t doubtful = 0;  ///< points whose neighbours or winding number contradict their orientation
  Eigen::Vector3d doubtful_at = Eigen::Vector3d::Zero();  ///< one of them
};

/// Normals of robust local planes, which follow the faces at edges, oriented outward; towards its inside in a cavity.
/// Where the cloud has sensor positions, towards these; neighbours decide where the line of sight grazes the surface,
/// and where nearly all of them say otherwise.
/// Else small flat patches, within which the sides are sure, are turned such that the winding number, the mean of both
/// sides of the surface, is one half everywhere, and that neighbours across their borders agree (a normal is mirrored
/// from one point to the other, which holds around edges and across thin walls). Patches that votes of neighbours join
/// are tried as groups. So walls are told apart that are one to two spacings and about five times the noise thick;
/// where the winding number stays far from one half the result is doubtful, as on a surface that is open on one side,
/// where the larger part decides. O(n log n + p^2) for the p patches, some thousands at most
/// @throws Cancelled
[[nodiscard]] EstimatedNormals estimate_normals(const PointCloud& cloud, const Scale& scale,
                                                const RunContext& run = {});

enum class NormalsVerdict {
  outward,    ///< as they should be
  inward,     ///< right but for the sign of all
  unoriented  ///< not across the surface, or with signs that contradict each other: of no use
};

/// What the normals of a cloud are worth, told from a sample of its points; by its sensor positions, where it has them,
/// which way they lead. Precondition: the cloud has normals.
/// O(n log n) @throws Cancelled
[[nodiscard]] NormalsVerdict check_normals(const PointCloud& cloud, const Scale& scale, const RunContext& run = {});

/// Its fields: see the table.
struct PrepareOptions {
  CleanOptions clean = {};
  bool is_exact = false, keep_normals = true;
};
void option_table(OptionsOf<PrepareOptions>, auto&& field) {
  using O = PrepareOptions;
  field(&O::clean, "clean", "Which points are left out");
  field(&O::is_exact, "is_exact",
        "The points lie on the surface and have its normals, as those drawn from a mesh: they are taken as they are, "
        "and only measured",
        k_library);
  field(&O::keep_normals, "keep_normals",
        "Keep given normals that are plausible: scanners know more than positions tell",
        {.opposite = "estimate-normals", .otherwise = "Do not use the normals that the cloud has"});
}

struct PreparedCloud {
  PointCloud cloud;  ///< with outward normals
  Scale scale;       ///< of the cleaned cloud
  CleanReport cleaning;
  bool normals_estimated = false;
  double clean_seconds = 0, normals_seconds = 0;
  std::vector<std::string> warnings = {};  ///< sentences for the user: what was changed, what is doubtful, and where
};

/// From a raw cloud to one that primitives can be detected in: measured, cleaned, with normals out of the solid. Given
/// normals that lead inward are turned, those that are of no use estimated anew. O(n log n)
/// @throws Error for too few points, before or after cleaning, or a wrong option; Cancelled.
[[nodiscard]] PreparedCloud prepare_cloud(const PointCloud& cloud, const PrepareOptions& options = {},
                                          const RunContext& run = {});

}  // namespace cloud2csg
