#pragma once

#include "cloud2csg/extract.hpp"

namespace cloud2csg {

/// How well the tree explains the cloud, point by point on the tree itself: nothing of the search's tables. `noise`
/// tells how near most points are to the surface: a large tree is evaluated by what of it is that near first.
[[nodiscard]] FitStatistics measure_fit(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud,
                                        const Objective& objective, double noise, const RunContext& run);

}  // namespace cloud2csg
