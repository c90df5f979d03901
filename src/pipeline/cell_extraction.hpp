#pragma once

#include "cloud2csg/advanced/cells.hpp"
#include "paper/partition/partition.hpp"

namespace cloud2csg {

/// The tree of the cells.
struct CellExtraction {
  CsgTree tree;  ///< over the input's primitives
  CellStatistics statistics;
  bool is_complete = true;  ///< false when it was stopped early
  SupportedPrimitives supported;
  CellComplex complex = {};
  std::vector<CellIndex> open_cells = {};
  std::vector<TreeStep> steps = {};
  std::vector<std::string> warnings;

  /// The share of what the points say that the tree does not contradict; none where few of them say anything.
  [[nodiscard]] double trust() const;
};

/// Absent when what is left after splitting off is too large to be solved. Fills in the seconds of its stages. The pass
/// over the points runs as `run` says, the search as `search_run`.
/// @throws Error when no point is near any primitive; Cancelled.
[[nodiscard]] std::optional<CellExtraction> extract_by_cells(const PointCloud& cloud, const PrimitiveSet& primitives,
                                                             const NoiseScale& scale, const ExtractOptions& options,
                                                             const RunContext& run, const RunContext& search_run,
                                                             StageSeconds& seconds);

/// See CellStatistics::open_volume. `box` is that of the cloud.
[[nodiscard]] double open_volume(const CellExtraction& extraction, const AlignedBox& box, const RunContext& run);

}  // namespace cloud2csg
