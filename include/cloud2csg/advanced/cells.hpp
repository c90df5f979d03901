#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/advanced/formula.hpp"
#include "cloud2csg/advanced/local_search.hpp"
#include "cloud2csg/advanced/rank_classes.hpp"
#include "cloud2csg/advanced/segmentation.hpp"
#include "cloud2csg/csg_tree.hpp"

/// Cells: the pieces into which the primitives cut space, with evidence from a cloud. A tree is a label (in or out of
/// the solid) for each cell. Few of the 2^n combinations of n primitives occur in space.
namespace cloud2csg {

/// The primitives that contain a place, ascending.
using Cell = std::vector<PrimitiveIndex>;
using CellIndex = std::uint32_t;

/// The border of two cells: the surface of the primitives (several where they coincide) that contain only one cell.
struct Patch {
  CellIndex first, second;  ///< first < second
  /// Number of points whose normals put only the first cell into the solid, or only the second. A point that is nearly
  /// on the surface of other primitives counts a quarter.
  double first_in = 0, second_in = 0;
  double area = 0;  ///< estimated from samples of the primitives' surfaces, which count like points
};

struct CellComplex {
  std::vector<Cell> cells;     ///< in lexicographic order; the first is outside of all primitives
  std::vector<Patch> patches;  ///< ascending by (first, second)
  /// Cells that reach to infinity, ascending: out of any bounded solid. The first cell only, without half-spaces.
  std::vector<CellIndex> unbounded = {0};
  /// By cell: number of lines of sight, from sensors to points on a primitive, that pass through it, times the points
  /// that each line represents. Empty where the cloud has no sensor positions.
  std::vector<double> seen_through = {};
  std::vector<std::size_t> points_of_primitive;  ///< number of points on the surface of each primitive
  std::size_t unassigned = 0;                    ///< points on no primitive
  std::vector<std::uint32_t> order;              ///< all points along a space-filling curve
};

/// Number of surface samples per primitive. They find cells and patches without points.
struct SampleCounts {
  std::size_t base = 48, a_neighbour = 40, most = 1024;
};
void option_table(OptionsOf<SampleCounts>, auto&& field) {
  using O = SampleCounts;
  field(&O::base, "base", "Samples of each primitive", at_least(1));
  field(&O::a_neighbour, "a_neighbour",
        "Additional samples for each other primitive whose bounds meet its own, since these cut it into pieces");
  field(&O::most, "most", "Largest number of samples of a primitive");
}

struct CellOptions {
  SegmentationTolerances tolerances;
  double noise;  ///< see estimate_noise()
  Precision precision = Precision::automatic;
  SampleCounts samples = {};
  std::size_t sight_lines = 20'000;  ///< largest number of lines, sampled over the whole cloud
};

/// Finds the cells and patches that points and samples of the primitives' surfaces meet, with their evidence. A point
/// is evidence where its side of every other primitive is clear: for the cells just inside and just outside of its
/// surface. With sensor positions, lines of sight are evidence that the cells which they cross well away from all
/// surfaces are empty. O(points x primitives near each + sight lines x primitives) time. The result does not depend on
/// the number of threads or the instruction set. Precondition: the cloud has normals and points.
/// @throws Cancelled
[[nodiscard]] CellComplex find_cells(const PointCloud& cloud, const PrimitiveSet& primitives,
                                     const CellOptions& options, const RunContext& run = {});

struct CellVolumes {
  std::vector<double> of_cell;  ///< by cell, in cubed units of length, clipped to the box
  double elsewhere = 0;         ///< volume of cells that find_cells() did not find
};

/// Estimates volumes inside the box from `places` deterministic samples. O(places x primitives)
[[nodiscard]] CellVolumes measure_volumes(const CellComplex& complex, const PrimitiveSet& primitives,
                                          const AlignedBox& box, std::size_t places = 5'000,
                                          const RunContext& run = {});

struct LabelOptions {
  double absence = 0.25, absence_in_scans = 0.05;
  double presence = 5, sight = 1;
};
void option_table(OptionsOf<LabelOptions>, auto&& field) {
  using O = LabelOptions;
  field(&O::absence, "absence",
        "A patch between a cell in the solid and one out of it should have this share of the points expected for its "
        "area; each missing point adds to the cost. 0.25: a surface that was mostly not seen is still believed.",
        at_least(0));
  field(&O::absence_in_scans, "absence_in_scans",
        "`absence` for clouds with sensor positions, if smaller. Of the surfaces that sensors could see, much is lost "
        "at grazing angles, at edges and in clefts.",
        at_least(0));
  field(&O::presence, "presence",
        "Number of expected points for which each point on a patch counts: a patch with some points was seen",
        at_least(0));
  field(&O::sight, "sight", "Cost of a line of sight through a cell in the solid, in points", at_least(0));
}

struct CellLabels {
  std::vector<bool> is_in = {};       ///< by cell
  std::vector<double> evidence = {};  ///< by cell: extra cost in points of changing this label alone; at least 0
  double density = 0;                 ///< points per area of surface where points are sparsest
  double points = 0;
  double cost = 0;  ///< see cost_of()
  LabelOptions options = {};
};

/// Finds the exact labels of least cost by a minimum cut (Boykov and Kolmogorov 2004). Unbounded cells are out. O(cells
/// + patches) and the cut, which is nearly linear in practice.
[[nodiscard]] CellLabels label_cells(const CellComplex& complex, const LabelOptions& options = {});

/// Cost of labels, in points: half a point per contradiction of a point to one of its two cells, missing points between
/// cells in and out of the solid, points seen through the solid. `density`: see CellLabels. O(cells + patches)
[[nodiscard]] double cost_of(const CellComplex& complex, const std::vector<bool>& is_in, double density,
                             const LabelOptions& options = {});

struct CellSolveOptions {
  std::vector<double> least_evidence = {12, 3, 1, 0.3};
  double leaf_cost = 3;
  MinimalFormulaOptions minimal = {.table_limit = std::size_t{1} << 18U, .combination_limit = 20'000'000};
  LocalSearchOptions climb = {.work_limit = 4e8};
};
void option_table(OptionsOf<CellSolveOptions>, auto&& field) {
  using O = CellSolveOptions;
  field(&O::least_evidence, "least_evidence",
        "The formula may ignore labels of cells that cost fewer points to change. Descending; each value is tried, and "
        "the formula with the least cost, leaves included, is taken.",
        at_least(0));
  field(&O::leaf_cost, "leaf_cost", "Cost of a leaf, in points", at_least(0));
  field(&O::minimal, "minimal",
        "Search for a minimal formula, core by core, where the formula that was taken may not be minimal");
  field(&O::climb, "climb",
        "Local searches from all formulas tried, unless the formula is proved minimal and costs less than a leaf more "
        "than the labels. They minimise the cost of cells and leaves: over all primitives for up to 64, core by core "
        "for more. The limits apply to each search; a work_limit of 0 disables them.");
}
/// Refuses evidence that does not descend.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const CellSolveOptions& options);

/// A step on the way to a tree, with the size of the best tree after it.
struct TreeStep {
  std::string name;
  std::size_t size = 0;
};

struct CellSolution {
  CsgTree tree = {};                       ///< over the primitives
  double least_evidence = 0;               ///< the limit that gave the tree
  double cost = 0;                         ///< cost_of() the tree's cells
  std::vector<CellIndex> open_cells = {};  ///< cells with evidence below least_evidence, ascending
  std::size_t peeled = 0;                  ///< primitives split off as wholly in or out of the remaining solid
  std::vector<std::size_t> cores = {};     ///< number of primitives in each remaining core
  /// Proved lower bound on the leaves of a tree with all sure labels. Absent when the tree lacks some sure label.
  std::optional<std::size_t> least_leaves = {};
  std::vector<TreeStep> steps = {};  ///< the steps that were needed, of "decomposition", "minimal formulas", "climbing"
  bool is_complete = true;           ///< false when stopped early
  [[nodiscard]] bool is_minimal() const { return least_leaves == leaf_count(tree); }
};

/// Finds a small tree with the label of each cell that is sure at the highest limit, and mostly of those at the chosen
/// limit. It leaves out primitives that no label depends on, repeatedly splits off primitives wholly in or out of the
/// remaining solid, and solves the remaining cores, which share no cells, one by one. Absent when a core has more than
/// 64 primitives. O(size of all cells), plus the cores. A triggered run.stop soon ends it with the best tree.
[[nodiscard]] std::optional<CellSolution> solve_cells(const CellComplex& complex, const CellLabels& labels,
                                                      const CellSolveOptions& options = {}, const RunContext& run = {});

}  // namespace cloud2csg
