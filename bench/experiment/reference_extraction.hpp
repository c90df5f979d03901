#pragma once

#include "cloud2csg/extract.hpp"

namespace cloud2csg {

/// The paper's steps and nothing else: overlap graph, maximal cliques, all trees of one or two primitives or the
/// genetic algorithm, merge, simplification. Each tree is evaluated at each point of its partition, as the paper's
/// program does, by reference_objective(); nothing is checked. Weights, partitions and random streams are those of
/// extract_csg(). Precondition: options.search is paper_ga_options(), strategy partition or baseline. @throws Error,
/// Cancelled
[[nodiscard]] Extraction reference_extraction(const PointCloud& cloud, const PrimitiveSet& primitives,
                                              const ExtractOptions& options, const RunContext& run);

}  // namespace cloud2csg
