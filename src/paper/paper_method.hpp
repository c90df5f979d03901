#pragma once

#include "cloud2csg/extract.hpp"

namespace cloud2csg {

/// Section 4 of the paper and nothing else: overlap graph, maximal cliques, all trees of one or two primitives or the
/// genetic algorithm, merge, simplification. Evaluates each tree at each point of its partition, as the paper's program
/// does, by reference_objective(), and checks nothing. Weights, partitions and random streams are those of
/// extract_csg(), which is held against this. O(evaluations x points x size). Precondition: options.search is
/// paper_ga_options(), the strategy partition or baseline. @throws Error, Cancelled
[[nodiscard]] Extraction extract_as_in_paper(const PointCloud& cloud, const PrimitiveSet& primitives,
                                             const ExtractOptions& options, const RunContext& run = {});

}  // namespace cloud2csg
