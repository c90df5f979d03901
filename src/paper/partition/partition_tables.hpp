#pragma once

#include <optional>
#include <vector>

#include "cloud2csg/advanced/rank_classes.hpp"
#include "paper/partition/partitions.hpp"

namespace cloud2csg {

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
