#pragma once

#include <optional>
#include <vector>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/extract.hpp"

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

/// How exact the points are.
struct NoiseScale {
  double noise;
  SegmentationTolerances tolerances;
};

/// Fills in the noise in the statistics, and its seconds.
[[nodiscard]] NoiseScale measure_scale(const PointCloud& cloud, const PrimitiveSet& primitives,
                                       const ExtractOptions& options, const RunContext& run,
                                       ExtractStatistics& statistics);

/// Primitives that points support, and which of the input's each is.
struct SupportedPrimitives {
  PrimitiveSet primitives;
  std::vector<PrimitiveIndex> original;
};
[[nodiscard]] SupportedPrimitives take_all(const PrimitiveSet& primitives);
/// Takes out those without points, with a warning each (of many, for some). Whether there were any.
/// @throws Error when there are only such.
bool drop_unsupported(std::span<const std::size_t> points_of_primitive, SupportedPrimitives& supported,
                      std::vector<std::string>& warnings);

/// The overlap graph; of unbounded primitives, that of what their points extend over.
[[nodiscard]] OverlapGraph overlap_graph_of(const PointCloud& cloud, const PrimitiveSet& primitives,
                                            const NoiseScale& scale, const ExtractOptions& options,
                                            const RunContext& run);

/// Everything the search needs, over the primitives that points support.
struct Preparation : SupportedPrimitives {
  NoiseScale scale{};
  OverlapGraph graph;
  std::vector<Clique> cliques;  ///< of the whole graph
  std::vector<std::vector<PrimitiveIndex>> components;
  std::vector<Clique> partitions;                       ///< what is searched for trees: cliques, or whole components
  std::vector<std::size_t> component_of;                ///< by partition
  std::vector<std::vector<std::size_t>> partitions_of;  ///< by component
  PointPass pass;                                       ///< a table a partition, then those of the components' windows
  std::vector<std::vector<TableWindow>> windows_of;     ///< by component: see Component::windows
};

/// Overlap graph, partitions and the pass over the points. Primitives without a single point are dropped, with a
/// warning in `statistics`, and the rest is prepared anew. Fills in the statistics of its stages.
/// @throws Error when no point is near any primitive; Cancelled.
[[nodiscard]] Preparation prepare(const PointCloud& cloud, const PrimitiveSet& primitives, const NoiseScale& scale,
                                  const ExtractOptions& options, const RunContext& run, ExtractStatistics& statistics);

/// How many bytes a table may take while it is made, when each of its points may be a class of its own.
inline constexpr std::size_t k_table_bytes = std::size_t{64} << 20U;

/// Tables over sets that are too large for that use every k-th point.
[[nodiscard]] std::size_t stride_for(std::size_t primitives, std::size_t points);

}  // namespace cloud2csg
