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

/// The whole method: a cloud and fitted primitives in, one tree out.
namespace cloud2csg {

enum class Strategy {
  automatic,  ///< whatever is best: by cells where the points bear that out, else partitions, checked and polished
  cells,      ///< space cut into cells, labelled by the points, and the solid taken apart: see cells.hpp
  partition,  ///< the paper's: a tree per maximal clique, merged
  baseline,   ///< the paper's baseline: all primitives in one genetic algorithm
};

/// What runs in parallel in the search. The result is the same for each.
enum class Parallel {
  none,        ///< one thread for everything
  population,  ///< the trees of a generation
  partitions,  ///< the partitions
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

/// Its fields: see the table.
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
        "cells: by the cells into which space is cut; partition: by cliques, as in the paper; baseline: all primitives "
        "at once; auto: by cells, and by partitions where the points do not bear them out");
  field(&O::parallel, "parallel", "What runs in parallel in the search; the result is the same for each");
  field(&O::segmentation, "segmentation", "Which points lie on which primitive", {.group = "Fit"});
  field(&O::objective, "objective", "Weights of the objective", {.group = "Fit"});
  field(&O::precision, "precision",
        "How exactly distances and angles are computed; auto: single where the noise is far above rounding",
        {.group = "Fit"});
  field(&O::search, "search", "The genetic algorithm; its seed is not used, but that of the extraction",
        {.group = "Genetic algorithm"});
  field(&O::cell_trust, "cell_trust",
        "Strategy auto: take the tree of the cells where enough points say something, and they contradict at most the "
        "share 1 - cell_trust of it. Elsewhere partitions are searched too, and the tree of the higher E is taken. 0: "
        "the tree of the cells wherever there is one; above 1: no cells.",
        at_least(0), k_library);
  field(&O::cell_samples, "cell_samples", "Samples of surfaces, to find cells without points", k_library);
  field(&O::cell_labels, "cell_labels", "What labels of cells cost", k_library);
  field(&O::cell_solve, "cell_solve", "From cells to the tree", k_library);
  field(&O::overlap_tolerance, "overlap_tolerance",
        "Primitives nearer than this overlap, in the cloud's units. So touching faces do.", at_least(0),
        {.absent = "the measured noise", .unit = "D", .group = "Fit"});
  field(&O::without_strangers, "without_strangers",
        "Judge a partition's trees without points inside primitives of others: no tree of the partition explains them. "
        "The paper judges by all points on its primitives.",
        {.option = "no-strangers",
         .opposite = "strangers",
         .otherwise = "Judge a partition's trees also by points inside primitives of others"});
  field(&O::polish, "polish",
        "Improve the merged trees by the whole cloud. Nodes are taken out as long as E over a component of up to 24 "
        "primitives grows. Where the tree of the cells was not taken at once, a local search by E over all points "
        "comes last, of up to 127 primitives. The paper has neither.",
        {.option = "polish", .opposite = "no-polish", .otherwise = "Take them as they are"});
  field(&O::time_limit_seconds, "time_limit_seconds",
        "Take the best tree so far when so many seconds have passed; reading and writing are not counted. The pass "
        "over the points, without which there is no tree, is always completed. The one option that makes a result "
        "depend on the machine's speed.",
        above(0), {.absent = "none", .unit = "SECONDS"});
  field(&O::seed, k_seed);
}

/// As in the paper: its weights, its genetic algorithm, no polish, full precision; strategy partition.
[[nodiscard]] ExtractOptions paper_options();

/// Wall-clock seconds of each stage; those of the command line (reading, writing) are filled in by it.
struct StageSeconds {
  double read = 0, clean = 0, normals = 0, detect = 0, solids = 0;
  double segment = 0, overlap = 0, partition = 0, classes = 0, search = 0, merge = 0, simplify = 0;
  double refine = 0;
  double write = 0;
  double extraction = 0;  ///< from cloud and primitives in memory to the simplified tree, or, refined, to the last one
  double total = 0;

  StageSeconds& operator+=(const StageSeconds& other);
};

struct PartitionStatistics {
  std::vector<PrimitiveIndex> primitives = {};  ///< indices into the input's primitives
  std::size_t points = 0, classes = 0;
  std::size_t generations = 0, evaluations = 0;
  double score = 0;           ///< E of the partition's tree over its own points
  std::size_t tree_size = 0;  ///< after simplification
};

/// How a component's partition trees became one.
enum class MergeWay {
  single,                  ///< there was one partition
  paper,                   ///< the paper's order went through and the result held
  dominance,               ///< by what primitives are to the partitions' trees: merge_by_dominance()
  largest_common_subtree,  ///< the paper's by largest common subtrees first
  joint,                   ///< partitions that did not merge were solved together
  search,  ///< a search over the whole component: up to 24 primitives from the best of these, up to 127 anew
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
  std::vector<MergeWay> ways;                    ///< one a connected component
  std::size_t merges = 0;                        ///< pairs of trees put together
  std::size_t blocked = 0;                       ///< pairs that had a common subtree but no valid merge node
  std::size_t failed_checks = 0;                 ///< merged trees that fell short of what the partitions promised
  std::size_t joint_solutions = 0;               ///< pairs of partitions solved together
  std::size_t generations = 0, evaluations = 0;  ///< of searches over whole components and their polish
  double worst_shortfall = 0;  ///< of the result: share of a primitive's promised score that is missing, worst one
};

/// Of the strategy by cells.
struct CellStatistics {
  std::size_t cells = 0, patches = 0;  ///< that occur in space
  std::size_t open_cells = 0;          ///< of which it is not sure whether they are in the solid
  /// Of these and of cells that were not found, the share in the volume that the primitives take up: estimated.
  double open_volume = 0;
  double speaking_points = 0;      ///< points that say something of the cells
  double contradicted_points = 0;  ///< of these, those that the tree contradicts, and those that it would need more
  std::size_t peeled = 0;          ///< primitives that were split off
  std::vector<std::size_t> cores;  ///< how many primitives the rests had that were solved by formula
  /// It is proved that no tree with all sure labels has fewer; absent when this one has not all of them.
  std::optional<std::size_t> least_leaves = {};
  bool is_minimal = false;  ///< it has no more

  /// Of what the points say, the share that is contradicted.
  [[nodiscard]] double contradicted_share() const { return contradicted_points / std::max(1.0, speaking_points); }
};

/// Of the way from a raw cloud to primitives.
struct FindingStatistics {
  std::size_t raw_points = 0;        ///< that were given; those that were left out are not in ExtractStatistics::points
  std::size_t added_points = 0;      ///< on a side that has none, and on hidden walls
  bool normals_estimated = false;    ///< those given were of no use, or there were none
  double diagonal = 0, spacing = 0;  ///< see Scale
  double noise = 0, tolerance = 0;   ///< of the points; how far they may be from their surface
  std::vector<SurfaceType> surfaces = {};   ///< that were found, the order is that of Snap::surface
  std::size_t known = 0, known_points = 0;  ///< primitives that were known, and the points on them
  std::size_t unexplained_points = 0;       ///< on no surface, and no known primitive
  std::vector<Snap> snaps = {};             ///< what was made regular, and by how much
  double disagreement = 0;                  ///< see SolidChoice
  bool is_tree_of_choice = false;           ///< the tree is the one that the solids were chosen with
};

struct TreeStatistics {
  std::size_t size = 0, leaves = 0, depth = 0, levels = 0;
};
/// O(size of the tree).
[[nodiscard]] TreeStatistics statistics_of(const CsgTree& tree);

struct FitStatistics {
  double objective = 0;                    ///< E of the result over all points
  double rms_distance = 0;                 ///< of the points to the surface of the result
  double p95_distance = 0;                 ///< 95 % of the points are nearer than this
  double rms_angle_deg = 0;                ///< between normals and the surface's
  double p95_angle_deg = 0;                ///< 95 % of the normals are nearer than this to the surface's
  SegmentationTolerances tolerances = {};  ///< in force
  std::size_t unexplained_points = 0;      ///< how many unexplained_points() there are with these tolerances
};

/// Of extract_refined_csg(): what became of the primitives. See Refinement.
struct RefineStatistics {
  bool is_taken = false;  ///< false: the result has the primitives that were given, and no change below is in it
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
  std::optional<CellStatistics> cells;       ///< when the tree is that of the cells
  std::optional<FindingStatistics> finding;  ///< when the primitives were found in the cloud
  std::optional<RefineStatistics> refine;    ///< when the primitives were to be refined
  std::vector<TreeStep> steps;               ///< on the way to the tree, and its nodes after each
  TreeStatistics before_simplification, tree;
  FitStatistics fit;
  StageSeconds seconds;
  std::vector<std::string> warnings;
};

/// What was found in a cloud, whichever way.
struct Extraction {
  Model model;  ///< primitives, and always a tree over them
  ExtractStatistics statistics = {};
  [[nodiscard]] const CsgTree& tree() const { return *model.tree; }
  // Where the primitives were found in the cloud:
  PointCloud cloud = {};                       ///< the points that were used: cleaned, with normals
  std::vector<DetectedSurface> surfaces = {};  ///< that these lie on, but for what lies on known primitives
  std::vector<SurfacePoints> points = {};      ///< of these, the ones on each of the primitives, as these were found
};

/// Section 4 of the paper from cloud to tree, with a merge that is checked against the cloud and cannot fail.
/// The same seed gives the same tree for any number of threads.
/// A triggered stop token ends the search with the best tree so far (statistics.complete is false).
/// @throws Error when the cloud has no normals or no points, there are no primitives, or no point is near any of them;
/// Cancelled when stopped before the search began.
[[nodiscard]] Extraction extract_csg(const PointCloud& cloud, const PrimitiveSet& primitives,
                                     const ExtractOptions& options = {}, const RunContext& run = {});

/// The refinement that goes with an extraction: normals may be as far off.
[[nodiscard]] RefineOptions refine_options_for(const ExtractOptions& extraction);

/// extract_csg(), refine_primitives() on its tree, and extract_csg() again over what comes out; of the trees over both
/// sets of primitives, the one with the highest E, measured with the refined noise. The statistics are those of the
/// extraction that was taken, with the seconds of all. Stopped early, or past its time limit: the best so far.
/// @throws Error as extract_csg() and validate(RefineOptions); Cancelled.
[[nodiscard]] Extraction extract_refined_csg(const PointCloud& cloud, const PrimitiveSet& primitives,
                                             const ExtractOptions& options = {},
                                             const RefineOptions& refine_options = {}, const RunContext& run = {});

/// The points that a tree does not explain: farther from its surface than the tolerance, or with a normal that is not
/// within the angle of the surface's outward one. Ascending. O(points x primitives near each)
[[nodiscard]] std::vector<std::uint32_t> unexplained_points(const Model& model, const PointCloud& cloud,
                                                            const SegmentationTolerances& tolerances,
                                                            const RunContext& run = {});

/// The statistics as the JSON of the command line's --stats.
[[nodiscard]] std::string to_json(const ExtractStatistics& statistics);

}  // namespace cloud2csg
