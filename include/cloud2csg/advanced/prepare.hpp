#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Size, density and noise of a cloud, in its units. Tolerances are multiples of them, independent of unit and origin.
struct Scale {
  AlignedBox box;  ///< bounds of the points without outliers
  double diagonal = 0.0;
  /// Square root of the surface area per point: the step of an equally dense square grid. For randomly drawn points the
  /// median distance to the nearest neighbour is half of it.
  double spacing = 0.0;
  /// Standard deviation of the points along the surface normal; 0 for exact points on planes.
  double noise = 0.0;
};

/// Measures a cloud from a sample of its points. Noise is the deviation from local quadrics whose size adapts to the
/// noise. It is a low percentile, which ignores edges and details, over the denser half of the sample, which has few
/// outliers. A neighbourhood is a ball and cuts noise off; the missing share is added. The noise is right to about a
/// quarter for noise of up to 0.5 % of the diagonal, if a third of the surface is smooth at four times the noise. At
/// 1 % it may be 1.5 times too large on parts with fine detail. With as many outliers as points it is up to twice too
/// large. The result does not depend on seed, unit and origin. O(n log n)
/// @throws Error for fewer than 10 points, or points all in one place; Cancelled.
[[nodiscard]] Scale estimate_scale(const PointCloud& cloud, const RunContext& run = {});

/// Which points of a raw cloud are left out.
struct CleanOptions {
  bool remove_outliers = true;
  std::size_t point_budget = 500'000;
};
void option_table(OptionsOf<CleanOptions>, auto&& field) {
  using O = CleanOptions;
  field(&O::remove_outliers, "remove_outliers",
        "Remove points that no surface passes through. This takes most of the time of the preparation.",
        {.opposite = "keep-outliers", .otherwise = "Do not remove outliers, for clean clouds"});
  field(&O::point_budget, "point_budget",
        "Thin clouds with more points to about this many. More points would not make later stages more accurate, only "
        "slower.",
        at_least(1));
}

/// Number of points that each step left out.
struct CleanReport {
  std::size_t duplicates = 0;   ///< at exactly the same place as another point
  std::size_t isolated = 0;     ///< far from all others
  std::size_t off_surface = 0;  ///< near others, but on none of their local planes, or doubted and on no surface
  std::size_t smoothed = 0;     ///< beside edges that a smoothing rounded, which only detection sees
  std::size_t thinned = 0;      ///< removed by down-sampling to the budget
};

struct CleanCloud {
  PointCloud cloud;  ///< remaining points in the order of the input, with normals and sensor positions
  CleanReport report;
  /// Ascending indices of points that are on no plane of their neighbours, but as densely surrounded as a surface. They
  /// belong to a small round feature or are outliers beside a face. Only the surfaces tell.
  std::vector<std::uint32_t> doubted = {};
};

/// Leaves out repeated points, outliers, and points beyond the budget. An outlier is a point that few of its
/// neighbours' local planes pass through (within three times the noise), so sparse regions, thin walls and edges stay.
/// Outliers as densely surrounded as a surface are only `doubted`. If the first pass finds many outliers, later passes
/// are stricter with distant points and with planes, since some planes arise by chance. With as many uniform outliers
/// as points, 94 % or more of those off the surface go or are doubted. Thinning keeps one point per voxel. Voxels are
/// at most three spacings or four times the noise wide, and the budget is that of points that are not doubted, so the
/// result may exceed it. O(n log n)
/// @throws Error for a budget of 0; Cancelled.
[[nodiscard]] CleanCloud clean_cloud(const PointCloud& cloud, const Scale& scale, const CleanOptions& options = {},
                                     const RunContext& run = {});

/// Normals from positions, with the certainty of their orientation.
struct EstimatedNormals {
  Points normals;          ///< unit length, out of the solid
  std::size_t bodies = 0;  ///< parts not connected by neighbours; 0 with sensors
  /// Points whose neighbours or winding number contradict their orientation, ascending.
  std::vector<std::uint32_t> doubtful = {};
};

/// Estimates normals from robust local planes, which follow the faces at edges, and orients them out of the material:
/// in a cavity, towards its inside. With sensor positions, normals face the sensor. Neighbours decide where the line of
/// sight grazes the surface, and where nearly all neighbours contradict.
/// Without sensors, it flips small flat patches of sure relative orientation. The winding number, averaged over both
/// sides of the surface, should be one half everywhere, and neighbours across patch borders should agree. Agreement
/// mirrors a normal from one point to the other, which is right around edges and across thin walls. Patches that
/// neighbours' votes join are also tried as groups. This separates walls that are one to two spacings and about five
/// times the noise thick. The result is doubtful where the winding number stays far from one half, as on a surface that
/// is open on one side; there the larger part decides. O(n log n + p^2) for p patches, at most some thousands.
/// @throws Cancelled
[[nodiscard]] EstimatedNormals estimate_normals(const PointCloud& cloud, const Scale& scale,
                                                const RunContext& run = {});

enum class NormalsVerdict {
  outward,
  inward,     ///< correct except for a common sign
  unoriented  ///< unusable: not across the surface, or with contradictory signs
};

/// Judges the normals of a cloud from a sample of its points, most strictly in the half where the cloud is flattest:
/// the points around an edge or a thin wall in noise have no plane that could contradict a normal. Sensor positions,
/// where present, decide about the sign. Precondition: the cloud has normals. O(n log n) @throws Cancelled
[[nodiscard]] NormalsVerdict check_normals(const PointCloud& cloud, const Scale& scale, const RunContext& run = {});

struct PrepareOptions {
  CleanOptions clean = {};
  bool is_exact = false, keep_normals = true;
};
void option_table(OptionsOf<PrepareOptions>, auto&& field) {
  using O = PrepareOptions;
  field(&O::clean, "clean", "Removal of outliers and of points beyond the budget");
  field(&O::is_exact, "is_exact",
        "The points lie exactly on the surface and have its normals, such as those drawn from a mesh: measure the "
        "cloud, but leave it unchanged",
        k_library);
  field(&O::keep_normals, "keep_normals",
        "Keep normals of the cloud that are plausible: scanners know more than positions tell",
        {.opposite = "estimate-normals", .otherwise = "Estimate normals even if the cloud has some"});
}

struct PreparedCloud {
  PointCloud cloud;  ///< with outward normals
  Scale scale;       ///< scale of the cleaned cloud without the doubted points
  CleanReport cleaning;
  std::vector<std::uint32_t> doubted = {};  ///< as in CleanCloud
  bool normals_estimated = false;
  double doubtful_normals = 0;  ///< share of the points whose estimated normals may point to the wrong side
  Eigen::Vector3d doubtful_place = Eigen::Vector3d::Zero();  ///< one of these points
  double clean_seconds = 0, normals_seconds = 0;
  std::vector<std::string> warnings = {};  ///< sentences for the user about the whole cloud
};

/// Prepares a raw cloud for detection: measures and cleans it, and gives it normals out of the solid. Flips given
/// normals that point inward; replaces unusable ones. O(n log n)
/// @throws Error for too few points, before or after cleaning, or an option out of range; Cancelled.
[[nodiscard]] PreparedCloud prepare_cloud(const PointCloud& cloud, const PrepareOptions& options = {},
                                          const RunContext& run = {});

}  // namespace cloud2csg
