#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/advanced/cells.hpp"
#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/evolve.hpp"
#include "cloud2csg/advanced/objective.hpp"
#include "cloud2csg/advanced/refine.hpp"
#include "cloud2csg/advanced/segmentation.hpp"
#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/advanced/surface.hpp"

/// The whole method: from a cloud and fitted primitives to one tree.
namespace cloud2csg {

enum class Strategy {
  automatic,  ///< cells where the points support their tree, else partitions, checked and polished; see reconstruct()
  cells,      ///< label the cells of space by the points and decompose the solid: see cells.hpp
  partition,  ///< the paper's method: one tree per maximal clique, merged
  baseline,   ///< the paper's baseline: one genetic algorithm over all primitives
};

/// The parallel parts of the search. The result does not depend on them.
enum class Parallel {
  none,        ///< one thread for everything
  population,  ///< the trees of a generation
  partitions,
  both,
};

constexpr auto names_of(Strategy /*any*/) {
  return std::to_array<EnumName<Strategy>>({{"auto", Strategy::automatic},
                                            {"cells", Strategy::cells},
                                            {"partition", Strategy::partition},
                                            {"baseline", Strategy::baseline}});
}
constexpr auto names_of(Parallel /*any*/) {
  return std::to_array<EnumName<Parallel>>({{"none", Parallel::none},
                                            {"population", Parallel::population},
                                            {"partitions", Parallel::partitions},
                                            {"both", Parallel::both}});
}

struct ExtractOptions {
  Strategy strategy = Strategy::automatic;
  Parallel parallel = Parallel::both;
  SegmentationOptions segmentation = {};
  ObjectiveOptions objective = {};
  Precision precision = Precision::automatic;
  GaOptions search = {};
  double cell_trust = 0.97;
  SampleCounts cell_samples = {};
  LabelOptions cell_labels = {};
  CellSolveOptions cell_solve = {};
  std::optional<double> overlap_tolerance = {};
  bool without_strangers = true, polish = true;
  std::optional<double> time_limit_seconds = {};
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<ExtractOptions>, auto&& field) {
  using O = ExtractOptions;
  field(&O::strategy, "strategy",
        "cells: by the cells into which the primitives cut space; partition: by cliques of overlapping primitives, as "
        "in the paper; baseline: all primitives at once; auto: by cells, and also by partitions where the points do "
        "not support the tree of the cells. Over solids that were found in the cloud, auto takes the tree that they "
        "were chosen with");
  field(&O::parallel, "parallel", "Parts of the search that run in parallel; the result does not depend on it");
  field(&O::segmentation, "segmentation", "Assignment of points to primitives", {.group = "Fit"});
  field(&O::objective, "objective", "Weights of the objective", {.group = "Fit"});
  field(&O::precision, "precision",
        "Floating-point precision of distances and angles; auto: single where the noise is far above rounding errors",
        {.group = "Fit"});
  field(&O::search, "search", "Genetic algorithm; uses the seed of the extraction instead of its own",
        {.group = "Genetic algorithm"});
  field(&O::cell_trust, "cell_trust",
        "Strategy auto: take the tree of the cells if enough points are evidence, and contradict at most the share 1 - "
        "cell_trust of it. Otherwise search partitions too and take the tree with the higher E. 0: take the tree of "
        "the cells wherever there is one; above 1: do not use cells.",
        at_least(0), k_library);
  field(&O::cell_samples, "cell_samples", "Samples of the primitives' surfaces, to find cells without points",
        k_library);
  field(&O::cell_labels, "cell_labels", "Costs of labelling cells as in or out of the solid", k_library);
  field(&O::cell_solve, "cell_solve", "Search for a small tree with the labels of the cells", k_library);
  field(&O::overlap_tolerance, "overlap_tolerance",
        "Distance below which primitives count as overlapping, in the cloud's units. Primitives with touching faces "
        "therefore overlap.",
        at_least(0), {.absent = "the measured noise", .unit = "D", .group = "Fit"});
  field(&O::without_strangers, "without_strangers",
        "Judge a partition's trees without points inside primitives that are not in it: none of its trees explains "
        "them. The paper judges by all points on the partition's primitives.",
        {.option = "no-strangers",
         .opposite = "strangers",
         .otherwise = "Judge a partition's trees also by points inside primitives that are not in it"});
  field(&O::polish, "polish",
        "Improve the merged trees on the whole cloud. Removes nodes as long as E increases, in components of up to 24 "
        "primitives. If the tree of the cells was not taken at once, a local search by E over all points follows, for "
        "up to 127 primitives. The paper does neither.",
        {.option = "polish", .opposite = "no-polish", .otherwise = "Do not improve the merged trees"});
  field(&O::time_limit_seconds, "time_limit_seconds",
        "Stop the search after this many seconds and keep the best result so far; reading and writing are not counted. "
        "The pass over the points, without which there is no tree, is always completed. This is the only option that "
        "makes the result depend on the speed of the machine.",
        above(0), {.absent = "none", .unit = "SECONDS"});
  field(&O::seed, k_seed);
}

/// The paper's options: its weights and genetic algorithm, full precision, strategy partition, no polish.
[[nodiscard]] ExtractOptions paper_options();

/// Wall-clock seconds of each stage. The command line fills in its own, read and write.
struct StageSeconds {
  double read = 0, clean = 0, normals = 0, detect = 0, solids = 0;
  double segment = 0, overlap = 0, partition = 0, classes = 0, search = 0, merge = 0, simplify = 0;
  double refine = 0;
  double write = 0;
  double extraction = 0;  ///< from cloud and primitives in memory to the last simplified tree
  double total = 0;

  StageSeconds& operator+=(const StageSeconds& other);
};

struct PartitionStatistics {
  std::vector<PrimitiveIndex> primitives = {};  ///< indices into the input's primitives
  std::size_t points = 0, classes = 0;
  std::size_t generations = 0, evaluations = 0;
  double score = 0;           ///< E of the partition's tree over its own points
  std::size_t tree_size = 0;  ///< number of nodes after simplification
};

/// How the partition trees of a component became one tree.
enum class MergeWay {
  single,                  ///< the component has one partition
  paper,                   ///< merge in the paper's order, which passed the check
  dominance,               ///< merge_by_dominance()
  largest_common_subtree,  ///< the paper's merge with the largest common subtrees first
  joint,                   ///< partitions that did not merge were solved together
  search,  ///< a search over the whole component: from the best tree so far for up to 24 primitives, anew for up to 127
};
constexpr auto names_of(MergeWay /*any*/) {
  return std::to_array<EnumName<MergeWay>>({{"single", MergeWay::single},
                                            {"paper", MergeWay::paper},
                                            {"dominance", MergeWay::dominance},
                                            {"largest_common_subtree", MergeWay::largest_common_subtree},
                                            {"joint", MergeWay::joint},
                                            {"search", MergeWay::search}});
}

struct MergeStatistics {
  std::vector<MergeWay> ways;  ///< one per connected component
  std::size_t merges = 0;
  std::size_t blocked = 0;                       ///< pairs with a common subtree but without a valid merge node
  std::size_t failed_checks = 0;                 ///< merged trees that score less than the partitions promised
  std::size_t joint_solutions = 0;               ///< pairs of partitions solved together
  std::size_t generations = 0, evaluations = 0;  ///< searches over whole components and their polish
  double worst_shortfall = 0;  ///< largest share of a primitive's promised score that the result misses
};

struct CellStatistics {
  std::size_t cells = 0, patches = 0;  ///< that occur in space
  std::size_t open_cells = 0;          ///< cells without a sure label
  /// Estimated share of the open cells, and of cells that were not found, in the primitives' total volume.
  double open_volume = 0;
  double speaking_points = 0;      ///< points that support or contradict labels
  double contradicted_points = 0;  ///< contradicting points and missing points of the tree, as cost_of() counts them
  std::size_t peeled = 0;          ///< primitives that were split off
  std::vector<std::size_t> cores;  ///< number of primitives in each core that was solved by formula
  /// Proved lower bound on the leaves of a tree with all sure labels. Absent when this tree lacks some sure label.
  std::optional<std::size_t> least_leaves = {};
  bool is_minimal = false;  ///< the tree has no more than least_leaves leaves

  /// Share of the speaking points that contradict the tree.
  [[nodiscard]] double contradicted_share() const { return contradicted_points / std::max(1.0, speaking_points); }
};

/// Why nobody saw a surface.
enum class Unseen {
  side,       ///< the part stood on it
  underside,  ///< it is below an overhang
  wall,       ///< it is deep in a hole
  bend,       ///< it is inside a bent pipe
};
constexpr auto names_of(Unseen /*any*/) {
  return std::to_array<EnumName<Unseen>>(
      {{"side", Unseen::side}, {"underside", Unseen::underside}, {"wall", Unseen::wall}, {"bend", Unseen::bend}});
}

/// A surface that was added or continued where nobody saw the part.
struct ClosedSurface {
  Unseen reason = Unseen::side;
  SurfaceType type = SurfaceType::plane;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< centre of the bounds of the added points
  std::size_t added_points = 0;                     ///< as dense as the cloud
  double seen = 0;                                  ///< share of the surface's points that the cloud has
};

/// Statistics of the way from a raw cloud to primitives.
struct FindingStatistics {
  std::size_t raw_points = 0;       ///< points given; ExtractStatistics::points counts those that remain after cleaning
  std::size_t smoothed_points = 0;  ///< points left out because a smoothing of the cloud rounded the edge beside them
  std::vector<ClosedSurface> closed = {};  ///< where nobody saw the part
  std::size_t added_points = 0;            ///< on these surfaces while solids were chosen
  bool normals_estimated = false;          ///< there were no usable normals
  double diagonal = 0, spacing = 0;        ///< see Scale
  double noise = 0, tolerance = 0;  ///< standard deviation of the points; largest distance of a point from its surface
  std::vector<SurfaceType> surfaces = {};   ///< types of the detected surfaces; Snap::surface is an index into them
  std::size_t known = 0, known_points = 0;  ///< number of known primitives and of points on them
  std::size_t unexplained_points = 0;       ///< points on no detected surface and no known primitive
  std::vector<Snap> snaps = {};             ///< surfaces made regular, and by how much
  std::vector<ChoiceRound> rounds = {};     ///< see SolidChoice
  double disagreement = 0;                  ///< see SolidChoice
};

struct TreeStatistics {
  std::size_t size = 0, leaves = 0, depth = 0, levels = 0;
  double price = 0;            ///< sum of price_of() the leaves
  std::size_t operations = 0;  ///< drawing a profile, or combining two solids
};
/// O(size of the tree).
[[nodiscard]] TreeStatistics statistics_of(const CsgTree& tree, const PrimitiveSet& primitives);

struct FitStatistics {
  double objective = 0;                    ///< E of the result over all points
  double rms_distance = 0;                 ///< root mean square distance of the points from the surface of the result
  double p95_distance = 0;                 ///< 95 % of the points are nearer to the surface than this
  double rms_angle_deg = 0;                ///< root mean square angle between normals and the surface's
  double p95_angle_deg = 0;                ///< 95 % of the normals are within this angle of the surface's
  SegmentationTolerances tolerances = {};  ///< the tolerances in force
  std::size_t unexplained_points = 0;      ///< number of unexplained_points() with these tolerances
  /// Indices of the points farther from the surface than these tolerances allow, ascending.
  std::vector<std::uint32_t> far_points = {};
};

/// How far a result can be trusted. docs/command_line.md has the thresholds.
enum class Grade {
  good,
  doubtful,  ///< usable, but a part of it contradicts the points or is a guess
  failed,    ///< no better than no result
};
constexpr auto names_of(Grade /*any*/) {
  return std::to_array<EnumName<Grade>>(
      {{"good", Grade::good}, {"doubtful", Grade::doubtful}, {"failed", Grade::failed}});
}

/// A connected region whose points are mostly off the result.
struct UnexplainedRegion {
  std::size_t points = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< centre of the bounds of these points
  double size = 0;                                  ///< diagonal of these bounds
};

/// Judgement of a result by the cloud's own points, without those that were added where nobody saw the part. A good
/// result may still lack what no point shows.
struct Verdict {
  Grade grade = Grade::good;
  double distance = 0;                 ///< tolerance, in the cloud's units
  std::size_t points = 0;              ///< number of points that judge
  double share_within = 0;             ///< share of these within the distance of the result; in detection, on a surface
  std::size_t unexplained_points = 0;  ///< number of these that are farther off or have another normal
  std::optional<double> disagreement = {};  ///< see SolidChoice; absent where it was not judged
  /// Share of the result's surface, within the bounds of the cloud, that has no points nearby. Absent likewise.
  std::optional<double> bare_surface = {};
  /// Share that has only points nearby that were added where nobody saw the part. Absent likewise.
  std::optional<double> closed_surface = {};
  std::vector<std::string> doubts = {};         ///< clauses about the result, with places; empty for a good result
  std::vector<UnexplainedRegion> regions = {};  ///< most points first
};

/// One line: "good: 99.2 % of the points within 0.12 of the surface", then the doubts.
[[nodiscard]] std::string to_text(const Verdict& verdict);

/// One line for each region, most points first: "unexplained: 412 points around (1, 2.5, 3), 4.1 across".
[[nodiscard]] std::vector<std::string> region_lines(const Verdict& verdict);

/// What extract_refined_csg() did to the primitives. See Refinement.
struct RefineStatistics {
  bool is_taken = false;  ///< false: the result has the given primitives, and the changes below do not apply
  int rounds = 0;
  std::size_t points = 0;
  double rms_before = 0, rms_after = 0;
  std::vector<PrimitiveChange> changes;
  std::vector<Regularity> regularities;
};

struct ExtractStatistics {
  Strategy strategy = Strategy::automatic;
  Parallel parallel = Parallel::both;
  int threads = 1;
  std::uint64_t seed = 1;
  bool complete = true;
  std::size_t points = 0, unassigned_points = 0;
  std::size_t primitives = 0;
  double noise = 0;
  std::vector<std::size_t> clique_histogram;
  std::size_t components = 0;
  std::vector<PartitionStatistics> partitions;
  MergeStatistics merge;
  std::optional<CellStatistics> cells;       ///< present when the tree comes from the cells
  std::optional<FindingStatistics> finding;  ///< present when the primitives were detected in the cloud
  std::optional<RefineStatistics> refine;    ///< present when refinement was requested
  std::vector<TreeStep> steps;               ///< steps on the way to the tree, with its size after each
  TreeStatistics before_simplification, tree;
  FitStatistics fit;
  Verdict verdict;
  StageSeconds seconds;
  std::vector<std::string> warnings;
};

/// The result of an extraction, with or without detection of primitives.
struct Extraction {
  Model model;  ///< the primitives and a tree over them; the tree is always present
  ExtractStatistics statistics = {};
  [[nodiscard]] const CsgTree& tree() const { return *model.tree; }
  // Only after detection of primitives:
  PointCloud cloud = {};  ///< the points used: cleaned, with normals
  /// Surfaces of the points that lie on no known primitive; also those that close what nobody saw, without points.
  std::vector<DetectedSurface> surfaces = {};
  std::vector<SurfacePoints> points = {};  ///< points of `cloud` on each primitive as it was detected
};

/// Section 4 of the paper, from cloud to tree. The merge is checked against the cloud and always gives a tree. The same
/// seed gives the same tree for any number of threads. A stop gives the best tree (statistics.complete is false).
/// @throws Error when the cloud has no normals or no points, there are no primitives, or no point is near any of them;
/// Cancelled when stopped before the search began.
[[nodiscard]] Extraction extract_csg(const PointCloud& cloud, const PrimitiveSet& primitives,
                                     const ExtractOptions& options = {}, const RunContext& run = {});

/// Refinement options that match an extraction: the same angle tolerance of normals.
[[nodiscard]] RefineOptions refine_options_for(const ExtractOptions& extraction);

/// Runs extract_csg(), refine_primitives() on its tree, and extract_csg() again over the refined primitives. Returns
/// the tree with the highest E among those over both sets of primitives, measured with the refined noise. Statistics
/// are those of its extraction, with the seconds of all steps. A stop or time limit gives the best so far.
/// @throws Error as extract_csg() and validate(RefineOptions); Cancelled.
[[nodiscard]] Extraction extract_refined_csg(const PointCloud& cloud, const PrimitiveSet& primitives,
                                             const ExtractOptions& options = {},
                                             const RefineOptions& refine_options = {}, const RunContext& run = {});

/// The points that a tree does not explain, ascending: those farther from its surface than the tolerance, or with a
/// normal outside of the angle tolerance around the surface's outward normal. O(points x primitives near each)
[[nodiscard]] std::vector<std::uint32_t> unexplained_points(const Model& model, const PointCloud& cloud,
                                                            const SegmentationTolerances& tolerances,
                                                            const RunContext& run = {});

/// The statistics as JSON, as the command line's --stats writes them.
[[nodiscard]] std::string to_json(const ExtractStatistics& statistics);

/// The verdict and the figures behind it as one line of JSON, as in the "verdict" of the statistics.
[[nodiscard]] std::string to_json(const Verdict& verdict);

}  // namespace cloud2csg
