#pragma once

#include "cloud2csg/extract.hpp"

namespace cloud2csg {

/// How well the tree explains the cloud, point by point on the tree itself: nothing of the search's tables.
[[nodiscard]] FitStatistics measure_fit(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud,
                                        const Objective& objective, const RunContext& run);

}  // namespace cloud2csg
