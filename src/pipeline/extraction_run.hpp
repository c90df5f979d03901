#pragma once

#include "cloud2csg/advanced/cells.hpp"
#include "cloud2csg/extract.hpp"
#include "paper/partition/partitions.hpp"
#include "paper/segment/supported_primitives.hpp"
#include "pipeline/time_limit.hpp"

namespace cloud2csg {

/// How the stages of one extraction run. When the time limit ends, the search stops with its best tree, but the pass
/// over the points, without which there is no tree, continues.
class ExtractionRun {
 public:
  /// `limit` must outlive this object.
  ExtractionRun(RunContext run, Parallel parallel, const TimeLimit& limit)
      : run_(std::move(run)), parallel_(parallel), limit_(limit) {}

  [[nodiscard]] RunContext pass() const { return with_threads(parallel_ != Parallel::none); }
  /// Several partitions in parallel.
  [[nodiscard]] RunContext partitions() const {
    return with_threads(parallel_ == Parallel::partitions || parallel_ == Parallel::both);
  }
  /// One search, maybe with a parallel population.
  [[nodiscard]] RunContext search() const {
    return limit_.limited(with_threads(parallel_ == Parallel::population || parallel_ == Parallel::both));
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

struct CellExtraction {
  /// Over the input's primitives; absent when a core is too large to be solved.
  std::optional<CsgTree> tree = {};
  CellStatistics statistics = {};
  bool is_complete = true;  ///< false when stopped early
  SupportedPrimitives supported;
  CellComplex complex = {};
  std::vector<CellIndex> open_cells = {};
  std::vector<TreeStep> steps = {};
  StageSeconds seconds = {};

  /// Share of the speaking points that agree with the tree; 0 when too few points speak.
  [[nodiscard]] double trust() const;
  /// Whether a tree over the input's primitives is an unbounded solid.
  [[nodiscard]] bool is_unbounded(const CsgTree& some) const;
};

/// Runs the pass over the points as run.pass(), the rest as run.search().
/// @throws Error when no point is near any primitive; Cancelled.
[[nodiscard]] CellExtraction extract_by_cells(const PointCloud& cloud, const PrimitiveSet& primitives,
                                              const NoiseScale& scale, const ExtractOptions& options,
                                              const ExtractionRun& run);

/// Computes CellStatistics::open_volume. `box` is the cloud's bounding box.
[[nodiscard]] double open_volume(const CellExtraction& extraction, const AlignedBox& box, const RunContext& run);

/// The merged tree from the partitions, with statistics.
struct PartitionExtraction {
  CsgTree tree;             ///< over the input's primitives
  bool is_complete = true;  ///< false when stopped early
  std::vector<PartitionStatistics> partitions = {};
  MergeStatistics merge = {};
  std::vector<std::size_t> clique_histogram = {};
  std::size_t components = 0;
  std::size_t unassigned = 0;             ///< points on no primitive
  std::vector<std::uint32_t> order = {};  ///< points along a space-filling curve
  std::vector<std::string> warnings = {};
  StageSeconds seconds = {};
};

/// Section 4 of the paper, with a merge that is checked against the cloud and has fall-backs: overlap graph, a tree per
/// partition, a tree per component, their union. Leaves out primitives without points, with a warning.
/// @throws Error when no point is near any primitive; Cancelled when stopped before the search began.
[[nodiscard]] PartitionExtraction extract_by_partitions(const PointCloud& cloud, const PrimitiveSet& primitives,
                                                        const NoiseScale& scale, const ExtractOptions& options,
                                                        const ExtractionRun& run);

/// Moves, turns and resizes the primitives of a finished extraction to fit the points, where that raises E. The tree
/// stays. A stop or the options' time limit leaves the extraction as it is, and says so.
[[nodiscard]] Extraction refined(Extraction result, const PointCloud& cloud, const ExtractOptions& options,
                                 const RefineOptions& refine_options, const RunContext& run);

}  // namespace cloud2csg
