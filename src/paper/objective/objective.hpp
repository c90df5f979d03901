#pragma once

#include "cloud2csg/extract.hpp"

namespace cloud2csg {

/// Measures how well the tree explains the cloud, without the search's tables. Open weights and tolerances follow from
/// the noise, which also tells how near most points are to the surface. Large trees are evaluated with near primitives
/// first, block by block in the `order` of the points (empty: as they are). That is fast if successive points are near.
[[nodiscard]] FitStatistics measure_fit(const Model& model, const PointCloud& cloud, double noise,
                                        const ExtractOptions& options, const RunContext& run,
                                        std::span<const std::uint32_t> order = {});

}  // namespace cloud2csg
