#pragma once

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

}  // namespace cloud2csg
