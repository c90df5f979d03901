#pragma once

#include "paper/partition/partitions.hpp"
#include "pipeline/extraction_run.hpp"

namespace cloud2csg {

/// The tree of the partitions, merged, and what it took.
struct PartitionExtraction {
  CsgTree tree;             ///< over the input's primitives
  bool is_complete = true;  ///< false when it was stopped early
  std::vector<PartitionStatistics> partitions = {};
  MergeStatistics merge = {};
  std::vector<std::size_t> clique_histogram = {};
  std::size_t components = 0;
  std::size_t unassigned = 0;             ///< points on no primitive
  std::vector<std::uint32_t> order = {};  ///< of the points: neighbours are near each other
  std::vector<std::string> warnings = {};
  StageSeconds seconds = {};
};

/// Section 4 of the paper, with a merge that is checked against the cloud and has fall-backs: the overlap graph, a tree
/// a partition, one tree a component, united. Primitives without points are left out, with a warning.
/// @throws Error when no point is near any primitive; Cancelled when stopped before the search began.
[[nodiscard]] PartitionExtraction extract_by_partitions(const PointCloud& cloud, const PrimitiveSet& primitives,
                                                        const NoiseScale& scale, const ExtractOptions& options,
                                                        const ExtractionRun& run);

}  // namespace cloud2csg
