#pragma once

#include <cstdint>
#include <vector>

#include "cloud2csg/view.hpp"
#include "core/fields/point_fit.hpp"

namespace cloud2csg {

/// Deviation of the points whose nearest surface belongs to one primitive.
struct OwnerDeviation {
  PrimitiveIndex primitive = 0;
  DeviationSummary summary = {};
};

struct Deviation {
  std::vector<std::uint32_t> order;  ///< points along a space-filling curve
  PointFit fit;                      ///< by point, with owners
  DeviationSummary summary = {};
  std::vector<OwnerDeviation> by_primitive = {};
  std::vector<std::uint32_t> worst = {};  ///< the farthest points, farthest first
  double noise = 0;                       ///< robust standard deviation of the distances
};

/// Measures all points' distances to the solid. O(points x primitives near each). @throws Cancelled
[[nodiscard]] Deviation measure_deviation(const Model& model, const PointCloud& cloud, const RunContext& run);

}  // namespace cloud2csg
