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

/// The sets of primitives to search a tree for: the maximal cliques of the overlap graph, or a strategy's choice.
struct Partitions {
  OverlapGraph graph;
  std::vector<Clique> cliques;  ///< cliques of the whole graph
  std::vector<std::vector<PrimitiveIndex>> components;
  std::vector<Clique> sets;                       ///< cliques, or whole components
  std::vector<std::size_t> component_of;          ///< by set
  std::vector<std::vector<std::size_t>> sets_of;  ///< by component
  double overlap_seconds = 0, partition_seconds = 0;
};

/// The overlap graph. Unbounded primitives count as the extent of their points.
[[nodiscard]] OverlapGraph overlap_graph_of(const PointCloud& cloud, const PrimitiveSet& primitives,
                                            const NoiseScale& scale, const ExtractOptions& options,
                                            const RunContext& run);

/// Section 4.1 of the paper: a partition is a maximal clique. The strategy `baseline` has one with all primitives;
/// `automatic` keeps components whole that can be listed. @throws Cancelled
[[nodiscard]] Partitions partition_primitives(const PointCloud& cloud, const PrimitiveSet& primitives,
                                              const NoiseScale& scale, const ExtractOptions& options,
                                              const RunContext& run);

/// A part of space, and the primitives that reach into it.
struct Region {
  AlignedBox box;
  std::vector<PrimitiveIndex> near;  ///< ascending
};

/// Cuts space in two again and again, until at most `limit` of the `primitives` (ascending) reach into each part, as
/// far as cuts can part them. `reach`: by primitive, boxes that may be infinite. The parts cover all of space and share
/// only sides. O(n log n) for boxes of bounded overlap.
[[nodiscard]] std::vector<Region> cut_into_regions(std::span<const PrimitiveIndex> primitives,
                                                   std::span<const AlignedBox> reach, std::size_t limit);

/// Components of up to this many primitives have one window and may be searched whole. Larger ones have windows for
/// each primitive: its points with all that overlaps it, cut into regions where that is many.
inline constexpr std::size_t k_whole_limit = RankClasses::k_shared_limit;

/// See MergeWindow.
struct TableWindow {
  std::size_t table;                          ///< index into PointPass::tables
  std::optional<PrimitiveIndex> judged = {};  ///< index in the component
};

/// The tables that trees are evaluated on: one a partition, then those of the components' windows.
struct PartitionTables {
  PointPass pass;
  std::vector<std::vector<TableWindow>> windows_of;  ///< by component: see Component::windows
};

/// Builds all tables in one pass over the points: see build_rank_classes(). @throws Cancelled
[[nodiscard]] PartitionTables build_partition_tables(const PointCloud& cloud, const PrimitiveSet& primitives,
                                                     const Partitions& partitions, const NoiseScale& scale,
                                                     const ExtractOptions& options, const RunContext& run);

/// A table for a few primitives, from a pass over them alone. `all_points`: also points on none. @throws Cancelled
[[nodiscard]] RankClasses build_table_over(const PrimitiveSet& members, const PointCloud& cloud,
                                           const NoiseScale& scale, const ExtractOptions& options, bool all_points,
                                           const RunContext& run);

}  // namespace cloud2csg
