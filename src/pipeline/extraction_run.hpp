#pragma once

#include "cloud2csg/advanced/cells.hpp"
#include "cloud2csg/extract.hpp"
#include "paper/partition/partitions.hpp"
#include "paper/segment/supported_primitives.hpp"
#include "pipeline/time_limit.hpp"

namespace cloud2csg {

/// How the stages of one extraction run. The pass over the points, without which there is no tree, goes on when the
/// time is over; the search, which always has a tree to give, stops then.
class ExtractionRun {
 public:
  /// `limit` must outlive this.
  ExtractionRun(RunContext run, Parallel parallel, const TimeLimit& limit)
      : run_(std::move(run)), parallel_(parallel), limit_(limit) {}

  [[nodiscard]] RunContext pass() const { return with_threads(parallel_ != Parallel::none); }
  /// Several partitions side by side.
  [[nodiscard]] RunContext partitions() const {
    return with_threads(parallel_ == Parallel::partitions || parallel_ == Parallel::both);
  }
  /// One search: its population in parallel, or not.
  [[nodiscard]] RunContext search() const {
    RunContext run = with_threads(parallel_ == Parallel::population || parallel_ == Parallel::both);
    run.stop = limit_.token();
    return run;
  }
  void enforce_limit() const { limit_.enforce(); }

 private:
  [[nodiscard]] RunContext with_threads(bool is_parallel) const {
    RunContext run = run_;
    if (!is_parallel) run.threads = 1;
    return run;
  }

  RunContext run_;
  Parallel parallel_;
  const TimeLimit& limit_;
};

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
