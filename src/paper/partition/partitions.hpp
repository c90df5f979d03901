#pragma once

#include <vector>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/extract.hpp"
#include "paper/segment/noise_scale.hpp"

namespace cloud2csg {

/// The sets of primitives that a tree is searched for each: the maximal cliques of the overlap graph, or what a
/// strategy takes in their place.
struct Partitions {
  OverlapGraph graph;
  std::vector<Clique> cliques;  ///< of the whole graph
  std::vector<std::vector<PrimitiveIndex>> components;
  std::vector<Clique> sets;                       ///< cliques, or whole components
  std::vector<std::size_t> component_of;          ///< by set
  std::vector<std::vector<std::size_t>> sets_of;  ///< by component
  double overlap_seconds = 0, partition_seconds = 0;
};

/// The overlap graph; of unbounded primitives, that of what their points extend over.
[[nodiscard]] OverlapGraph overlap_graph_of(const PointCloud& cloud, const PrimitiveSet& primitives,
                                            const NoiseScale& scale, const ExtractOptions& options,
                                            const RunContext& run);

/// Section 4.1 of the paper: a partition is a maximal clique. The strategy `baseline` has one with all primitives,
/// `automatic` takes components that can be listed as they are. @throws Cancelled
[[nodiscard]] Partitions partition_primitives(const PointCloud& cloud, const PrimitiveSet& primitives,
                                              const NoiseScale& scale, const ExtractOptions& options,
                                              const RunContext& run);

}  // namespace cloud2csg
