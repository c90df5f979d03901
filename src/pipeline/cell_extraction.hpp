#pragma once

#include "cloud2csg/advanced/cells.hpp"
#include "paper/segment/supported_primitives.hpp"
#include "pipeline/extraction_run.hpp"

namespace cloud2csg {

/// The tree of the cells.
struct CellExtraction {
  /// Over the input's primitives; absent when what is left after splitting off is too large to be solved.
  std::optional<CsgTree> tree = {};
  CellStatistics statistics = {};
  bool is_complete = true;  ///< false when it was stopped early
  SupportedPrimitives supported;
  CellComplex complex = {};
  std::vector<CellIndex> open_cells = {};
  std::vector<TreeStep> steps = {};
  StageSeconds seconds = {};

  /// The share of what the points say that the tree does not contradict; none where few of them say anything.
  [[nodiscard]] double trust() const;
  /// Whether the solid of a tree over the input's primitives goes on without end.
  [[nodiscard]] bool is_unbounded(const CsgTree& some) const;
};

/// The pass over the points runs as run.pass(), what follows as run.search().
/// @throws Error when no point is near any primitive; Cancelled.
[[nodiscard]] CellExtraction extract_by_cells(const PointCloud& cloud, const PrimitiveSet& primitives,
                                              const NoiseScale& scale, const ExtractOptions& options,
                                              const ExtractionRun& run);

/// See CellStatistics::open_volume. `box` is that of the cloud.
[[nodiscard]] double open_volume(const CellExtraction& extraction, const AlignedBox& box, const RunContext& run);

}  // namespace cloud2csg
