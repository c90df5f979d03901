#pragma once

#include "cloud2csg/extract.hpp"

namespace cloud2csg {

/// How well the tree explains the cloud, point by point on the tree itself: nothing of the search's tables. Weights and
/// tolerances that the options leave open follow from the noise, which also tells how near most points are to the
/// surface: a large tree is evaluated by what of it is that near first, block by block in the `order` of the points
/// (empty: as they are), which is fast where neighbours are near each other.
[[nodiscard]] FitStatistics measure_fit(const Model& model, const PointCloud& cloud, double noise,
                                        const ExtractOptions& options, const RunContext& run,
                                        std::span<const std::uint32_t> order = {});

}  // namespace cloud2csg
