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

/// Cells: the pieces into which the primitives cut space, and what a cloud says of them. A tree says of each cell
/// whether it is in the solid, and nothing else; few of the 2^n combinations of n primitives occur in space.
namespace cloud2csg {

/// The primitives that a place is inside of, ascending.
using Cell = std::vector<PrimitiveIndex>;
using CellIndex = std::uint32_t;

/// Where two cells meet: at the surface of the primitives that only one of them is inside of; more than one where
/// surfaces coincide.
struct Patch {
  CellIndex first, second;  ///< first < second
  /// Points on it whose normals say that the first cell is in the solid and the second is not, and the other way
  /// round. A point that is nearly on the surface of other primitives, too, counts a quarter.
  double first_in = 0, second_in = 0;
  double area = 0;  ///< estimated from samples of the primitives' surfaces; in the same sense of counting
};

struct CellComplex {
  std::vector<Cell> cells;     ///< in lexicographic order; the first is outside of all primitives
  std::vector<Patch> patches;  ///< ascending by (first, second)
  /// Those that reach to infinity, ascending: they cannot be in a bounded solid. The first cell, but where half-spaces
  /// shut it in.
  std::vector<CellIndex> unbounded = {0};
  /// By cell: lines of sight from the sensors to points on a primitive that pass through it, each counted as the points
  /// that it stands for. Empty where the cloud has no sensor positions.
  std::vector<double> seen_through = {};
  std::vector<std::size_t> points_of_primitive;  ///< how many points are on the surface of each primitive
  std::size_t unassigned = 0;                    ///< points that are on none
  std::vector<std::uint32_t> order;              ///< all points, so that neighbours are near each other
};

/// How many samples of its surface a primitive gets, to find cells and patches without points: see the table.
struct SampleCounts {
  std::size_t base = 48, a_neighbour = 40, most = 1024;
};
void option_table(OptionsOf<SampleCounts>, auto&& field) {
  using O = SampleCounts;
  field(&O::base, "base", "Samples of each primitive", at_least(1));
  field(&O::a_neighbour, "a_neighbour",
        "So many more for each other one whose bounds meet its own: there it is cut in pieces");
  field(&O::most, "most", "So many in all, at most");
}

struct CellOptions {
  SegmentationTolerances tolerances;
  double noise;  ///< see estimate_noise()
  Precision precision = Precision::automatic;
  SampleCounts samples = {};
  std::size_t sight_lines = 20'000;  ///< at most so many are looked at, of points all over the cloud
};

/// The cells that points and samples of the primitives' surfaces meet, with what they say. A point speaks where it is
/// clear on which side of each other primitive it lies: of the cell just inside and just outside of the surface that it
/// is on. Where the sensors stood is known, lines of sight say of the cells that they pass through clearly, away from
/// all surfaces, that these are empty. O(points x primitives near each + sight lines x primitives) time. The result
/// does not depend on the number of threads or the instruction set. Precondition: the cloud has normals and points.
/// @throws Cancelled
[[nodiscard]] CellComplex find_cells(const PointCloud& cloud, const PrimitiveSet& primitives,
                                     const CellOptions& options, const RunContext& run = {});

/// What the pieces take up.
struct CellVolumes {
  std::vector<double>
      of_cell;           ///< by cell, in cubed units of length; of those that reach out of the box, what is inside
  double elsewhere = 0;  ///< of cells that find_cells() did not find
};

/// Estimated by so many places in the box, always the same. O(places x primitives)
[[nodiscard]] CellVolumes measure_volumes(const CellComplex& complex, const PrimitiveSet& primitives,
                                          const AlignedBox& box, std::size_t places = 5'000,
                                          const RunContext& run = {});

/// Its fields: see the table.
struct LabelOptions {
  double absence = 0.25, absence_in_scans = 0.05;
  double presence = 5, sight = 1;
};
void option_table(OptionsOf<LabelOptions>, auto&& field) {
  using O = LabelOptions;
  field(
      &O::absence, "absence",
      "Where a patch between a cell of the solid and one that is not has fewer points than this share of what its area "
      "lets expect, those that are missing cost. A quarter: a surface of which most was not seen is still believed.",
      at_least(0));
  field(&O::absence_in_scans, "absence_in_scans",
        "The same, where it is less, for clouds that say where their sensors stood. Of what these could see much is "
        "lost at a slant, at edges and in clefts.",
        at_least(0));
  field(&O::presence, "presence",
        "Points that a patch has stand for so many of those: where there are some, it was seen", at_least(0));
  field(&O::sight, "sight", "Cost of a line of sight through a cell of the solid, in points", at_least(0));
}

struct CellLabels {
  std::vector<bool> is_in = {};       ///< by cell: whether it is in the solid
  std::vector<double> evidence = {};  ///< by cell: how many points more it costs to change its label alone; at least 0
  double density = 0;                 ///< points per area of what is surface, where they are sparse
  double points = 0;                  ///< that speak
  double cost = 0;                    ///< see cost_of()
  LabelOptions options = {};          ///< what they were made with
};

/// Tells which cells are in the solid: the labels with the least cost, exactly, by a minimum cut between the cells
/// (Boykov and Kolmogorov 2004). Cells that reach to infinity are out. O(cells + patches) and the cut, which is
/// nearly linear in practice.
[[nodiscard]] CellLabels label_cells(const CellComplex& complex, const LabelOptions& options = {});

/// What it costs to have just these cells in the solid, in points: those that say the opposite of one of their two
/// cells, a half for each, those that are missing on patches between a cell that is in and one that is not, and those
/// that were seen through the solid.
/// `density` as in CellLabels. O(cells + patches)
[[nodiscard]] double cost_of(const CellComplex& complex, const std::vector<bool>& is_in, double density,
                             const LabelOptions& options = {});

/// Its fields: see the table.
struct CellSolveOptions {
  std::vector<double> least_evidence = {12, 3, 1, 0.3};
  double leaf_cost = 3;
  MinimalFormulaOptions minimal = {.table_limit = std::size_t{1} << 18U, .combination_limit = 20'000'000};
  LocalSearchOptions climb = {.work_limit = 4e8};
};
void option_table(OptionsOf<CellSolveOptions>, auto&& field) {
  using O = CellSolveOptions;
  field(&O::least_evidence, "least_evidence",
        "The formula may do as it likes with cells whose labels cost fewer points to change. Descending; each is "
        "tried, and that formula taken that costs least, leaves included.",
        at_least(0));
  field(&O::leaf_cost, "leaf_cost", "Cost of a leaf, in points", at_least(0));
  field(&O::minimal, "minimal",
        "Where the formula that was taken may not be minimal, a minimal one is looked for, core by core");
  field(&O::climb, "climb",
        "Where it is not proved to be minimal, or its cells cost more than the labels by a leaf, local searches go on "
        "from all that was tried. By what the cells and leaves of a tree cost: over all of up to 64 primitives, of "
        "more core by core. The limits are those of each search; no work, no climbing.");
}
/// Evidence that does not descend.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const CellSolveOptions& options);

/// A step on the way to a tree, and the nodes of the best one after it.
struct TreeStep {
  std::string name;
  std::size_t size = 0;
};

struct CellSolution {
  CsgTree tree = {};                       ///< over the primitives
  double least_evidence = 0;               ///< the one that was taken
  double cost = 0;                         ///< of the tree's cells: see cost_of()
  std::vector<CellIndex> open_cells = {};  ///< those whose labels were not sure enough, ascending
  std::size_t peeled = 0;  ///< primitives that were split off since they are wholly in, or wholly out of, the rest
  std::vector<std::size_t> cores = {};  ///< how many primitives each of the parts has that are left then
  /// It is proved that no tree with the labels that are sure has fewer. Absent when the tree has not all of these.
  std::optional<std::size_t> least_leaves = {};
  std::vector<TreeStep> steps = {};  ///< "decomposition", "minimal formulas", "climbing": those that were needed
  bool is_complete = true;           ///< false when it was stopped early
  [[nodiscard]] bool is_minimal() const { return least_leaves == leaf_count(tree); }
};

/// A small tree that has the label of each cell that is sure at the highest limit, and mostly at the one taken.
/// Primitives that no label depends on are left out; those that are wholly in the solid, or wholly out of it, but for
/// what others add or take, are split off, again and again, until nothing or a core is left; parts of it that share no
/// cell are solved one by one. Absent when one of them has more than 64 primitives. O(size of all cells) but for the
/// cores. A triggered run.stop ends it soon, with the best tree so far.
[[nodiscard]] std::optional<CellSolution> solve_cells(const CellComplex& complex, const CellLabels& labels,
                                                      const CellSolveOptions& options = {}, const RunContext& run = {});

}  // namespace cloud2csg
