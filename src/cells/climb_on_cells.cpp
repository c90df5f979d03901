#include "cells/climb_on_cells.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "cells/label_costs.hpp"
#include "cells/tree_cells.hpp"
#include "cloud2csg/advanced/restrict.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/tree/local_search.hpp"

namespace cloud2csg {
namespace {

/// More than any cloud has points.
constexpr double k_forbidden = 1e12;

bool is_set(std::span<const std::uint64_t> column, CellIndex cell) {
  return (column[cell / 64] >> (cell % 64) & 1U) != 0;
}

/// A part of the solid whose tree is looked for while the rest stays as it is.
struct ClimbedPart {
  std::vector<PrimitiveIndex> primitives;  // of its tree, ascending
  std::vector<CellIndex> cells;            // that are in the solid just where they are in the part, or just where not
  bool is_inverted = false;                // just where not
  bool is_bounded = false;                 // its tree must be out of all that none of its primitives holds
};

/// What the cells of a tree of a part cost, over the places in part.primitives.
class PartObjective {
 public:
  PartObjective(const CellComplex& complex, const CellLabels& labels, LabelCosts costs, const ClimbedPart& part,
                double most_evidence)
      : is_inverted_(part.is_inverted), costs_(std::move(costs)), rows_(part.primitives.size()) {
    for (CellIndex row = 0; row < part.cells.size(); ++row) {
      const CellIndex cell = part.cells[row];
      rows_.add(places(complex.cells[cell], part.primitives), false);
      if (labels.evidence[cell] >= most_evidence) costs_.add(row, !labels.is_in[cell], k_forbidden);
    }
    if (!part.is_bounded) return;
    rows_.add({}, false);
    costs_.add(costs_.add_cell(), !is_inverted_, k_forbidden);
  }

  [[nodiscard]] double operator()(const CsgTree& tree) const {
    const std::vector<std::uint64_t> holds = evaluate(tree, rows_);
    return costs_.of([&](CellIndex row) { return is_set(holds, row) != is_inverted_; });
  }

  /// Words and cells that an evaluation looks at.
  [[nodiscard]] double work() const { return static_cast<double>(rows_.rows() + costs_.borders().size()); }
  [[nodiscard]] double work_per_node() const { return static_cast<double>(rows_.words()); }

 private:
  /// Of those of `primitives` that a cell is inside of.
  static std::vector<PrimitiveIndex> places(const Cell& cell, std::span<const PrimitiveIndex> primitives) {
    std::vector<PrimitiveIndex> result;
    for (PrimitiveIndex place = 0; place < primitives.size(); ++place) {
      if (std::ranges::binary_search(cell, primitives[place])) result.push_back(place);
    }
    return result;
  }

  bool is_inverted_;
  LabelCosts costs_;
  PartialFunction rows_;  // a row a cell
};

/// A tree over the set's indices as one over the places in `primitives`, which has all of its own.
CsgTree over_places(const CsgTree& tree, std::span<const PrimitiveIndex> primitives) {
  std::vector<PrimitiveIndex> place(primitives.back() + std::size_t{1});
  for (PrimitiveIndex k = 0; k < primitives.size(); ++k) place[primitives[k]] = k;
  return renumber(tree, place);
}

/// `costs`: of the part's cells.
CsgTree climb(const CellComplex& complex, const CellLabels& labels, LabelCosts costs, const ClimbedPart& part,
              std::span<const CsgTree> starts, const CellSolveOptions& options, const RunContext& run) {
  const PartObjective cost(complex, labels, std::move(costs), part, std::ranges::max(options.least_evidence));
  const TreeObjective objective{.primitives = part.primitives.size(),
                                .geometry = [&cost](const CsgTree& tree) { return -cost(tree); },
                                .alpha = options.leaf_cost / 2,  // a leaf more is two nodes more
                                .work = cost.work(),
                                .work_per_node = cost.work_per_node()};
  std::optional<LocalOptimum> best;
  for (const CsgTree& start : starts) {
    LocalOptimum climbed = local_search(objective, over_places(start, part.primitives), options.climb, run);
    if (!best || climbed.score > best->score) best = std::move(climbed);
  }
  return renumber(simplify(best->tree), part.primitives);
}

/// Which cells each core decides.
class CoreCells {
 public:
  CoreCells(const CellComplex& complex, const TakenApart& parts)
      : complex_(complex),
        parts_(parts),
        core_of_(complex.points_of_primitive.size(), k_none),
        cells_of_(parts.cores.size()) {
    for (const PeeledRound& round : parts.rounds) {
      for (const PrimitiveIndex p : round.primitives) core_of_[p] = k_peeled;
    }
    for (std::size_t core = 0; core < parts.cores.size(); ++core) {
      for (const PrimitiveIndex p : parts.cores[core].primitives) core_of_[p] = core;
    }
    for (CellIndex cell = 0; cell < complex.cells.size(); ++cell) {
      for (const std::size_t core : cores_at(cell)) cells_of_[core].push_back(cell);
    }
  }

  /// Where no other core's tree holds.
  [[nodiscard]] ClimbedPart part(std::size_t core, std::span<const CsgTree> trees) const {
    ClimbedPart part{.primitives = parts_.cores[core].primitives,
                     .cells = {},
                     .is_inverted = parts_.is_inverted,
                     .is_bounded = true};
    for (const CellIndex cell : cells_of_[core]) {
      const bool others_hold = std::ranges::any_of(
          cores_at(cell), [&](std::size_t other) { return other != core && holds(trees[other], cell); });
      if (!others_hold) part.cells.push_back(cell);
    }
    return part;
  }

  [[nodiscard]] bool holds(const CsgTree& tree, CellIndex cell) const {
    std::vector<bool> inside(core_of_.size());
    for (const PrimitiveIndex p : complex_.cells[cell]) inside[p] = true;
    return contains(tree, inside);
  }

 private:
  static constexpr std::size_t k_none = static_cast<std::size_t>(-1), k_peeled = k_none - 1;

  /// Of which a cell has primitives: none where one that was split off decides it.
  [[nodiscard]] std::vector<std::size_t> cores_at(CellIndex cell) const {
    std::vector<std::size_t> cores;
    for (const PrimitiveIndex p : complex_.cells[cell]) {
      if (core_of_[p] == k_peeled) return {};
      if (core_of_[p] != k_none && std::ranges::find(cores, core_of_[p]) == cores.end()) cores.push_back(core_of_[p]);
    }
    return cores;
  }

  const CellComplex& complex_;
  const TakenApart& parts_;
  std::vector<std::size_t> core_of_;  // by primitive
  std::vector<std::vector<CellIndex>> cells_of_;
};

}  // namespace

CsgTree climb_as_whole(const CellComplex& complex, const CellLabels& labels, std::span<const CsgTree> starts,
                       const CellSolveOptions& options, const RunContext& run) {
  ClimbedPart part;
  part.primitives.resize(complex.points_of_primitive.size());
  part.cells.resize(complex.cells.size());
  std::iota(part.primitives.begin(), part.primitives.end(), PrimitiveIndex{0});
  std::iota(part.cells.begin(), part.cells.end(), CellIndex{0});
  return climb(complex, labels, LabelCosts(complex, labels.density, labels.options), part, starts, options, run);
}

CsgTree climb_core_by_core(const CellComplex& complex, const CellLabels& labels, SolvedCores cores,
                           std::span<const CsgTree> others, const CellSolveOptions& options, const RunContext& run) {
  const LabelCosts costs(complex, labels.density, labels.options);
  const CoreCells cells(complex, cores.parts);
  std::vector<bool> is_in = cells_in(put_together(cores.parts, cores.trees), complex);
  for (std::size_t core = 0; core < cores.trees.size() && !run.stop.stop_requested(); ++core) {
    if (leaf_count(cores.trees[core]) == cores.least_leaves[core]) continue;
    const ClimbedPart part = cells.part(core, cores.trees);
    std::vector<CsgTree> starts{cores.trees[core]};
    for (const CsgTree& other : others) {
      CsgTree start = restrict_to(other, part.primitives);
      if (!is_constant(start) && std::ranges::find(starts, start) == starts.end()) starts.push_back(std::move(start));
    }
    cores.trees[core] = climb(complex, labels, costs.of_part(part.cells, is_in), part, starts, options, run);
    for (const CellIndex cell : part.cells) is_in[cell] = cells.holds(cores.trees[core], cell) != part.is_inverted;
  }
  return put_together(cores.parts, cores.trees);
}

}  // namespace cloud2csg
