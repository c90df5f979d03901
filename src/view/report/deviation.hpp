#pragma once

#include <cstdint>
#include <vector>

#include "cloud2csg/view.hpp"
#include "core/fields/point_fit.hpp"

namespace cloud2csg {

/// Of the points whose nearest part of the surface is a primitive's.
struct OwnerDeviation {
  PrimitiveIndex primitive = 0;
  DeviationSummary summary = {};
};

struct Deviation {
  std::vector<std::uint32_t> order;  ///< of the points, neighbours together
  PointFit fit;                      ///< with owners, by point
  DeviationSummary summary = {};     ///< of all points
  std::vector<OwnerDeviation> by_primitive = {};
  std::vector<std::uint32_t> worst = {};  ///< the points that are farthest off, the farthest first
  double noise = 0;                       ///< robust standard deviation of the distances
};

/// Distances of all points to the solid, and what they come to. O(points x primitives near each). @throws Cancelled
[[nodiscard]] Deviation measure_deviation(const Model& model, const PointCloud& cloud, const RunContext& run);

}  // namespace cloud2csg
