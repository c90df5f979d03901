#pragma once

#include <cstddef>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/advanced/scale.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

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

}  // namespace cloud2csg
