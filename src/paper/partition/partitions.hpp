#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/advanced/rank_classes.hpp"
#include "cloud2csg/extract.hpp"
#include "cloud2csg/geometry.hpp"
#include "cloud2csg/primitive.hpp"
#include "paper/segment/supported_primitives.hpp"

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

/// A part of space, and those of some primitives that reach into it.
struct Region {
  AlignedBox box;
  std::vector<PrimitiveIndex> near;  ///< ascending
};

/// Cuts space in two and in two again, until at most `limit` of the `primitives` (ascending) reach into each part, as
/// far as cuts can part them. `reach`: by primitive, boxes that may be infinite. The parts cover all of space, and
/// share only sides. O(n log n) for boxes of bounded overlap.
[[nodiscard]] std::vector<Region> cut_into_regions(std::span<const PrimitiveIndex> primitives,
                                                   std::span<const AlignedBox> reach, std::size_t limit);

/// Components of up to so many primitives have one window, and may be searched as a whole. Larger ones have
/// them for each primitive: the points that belong to it, with all that overlaps it; where that is many, in regions
/// that few of them reach into.
inline constexpr std::size_t k_whole_limit = RankClasses::k_shared_limit;

/// See MergeWindow.
struct TableWindow {
  std::size_t table;                          ///< index into PointPass::tables
  std::optional<PrimitiveIndex> judged = {};  ///< index in the component
};

/// What trees are evaluated on: a table a partition, then those of the components' windows.
struct PartitionTables {
  PointPass pass;
  std::vector<std::vector<TableWindow>> windows_of;  ///< by component: see Component::windows
};

/// One pass over the points for all of them: see build_rank_classes(). @throws Cancelled
[[nodiscard]] PartitionTables build_partition_tables(const PointCloud& cloud, const PrimitiveSet& primitives,
                                                     const Partitions& partitions, const NoiseScale& scale,
                                                     const ExtractOptions& options, const RunContext& run);

/// A table of its own for a few primitives: the pass looks at no other. `all_points`: also those on none of them.
/// @throws Cancelled
[[nodiscard]] RankClasses build_table_over(const PrimitiveSet& members, const PointCloud& cloud,
                                           const NoiseScale& scale, const ExtractOptions& options, bool all_points,
                                           const RunContext& run);

}  // namespace cloud2csg
