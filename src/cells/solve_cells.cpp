#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "cells/few_levels.hpp"
#include "cells/label_costs.hpp"
#include "cells/take_apart.hpp"
#include "cells/tree_cells.hpp"
#include "cloud2csg/advanced/cells.hpp"
#include "cloud2csg/advanced/restrict.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/tree/local_search.hpp"

namespace cloud2csg {
namespace {

/// A solid's cores with their trees and the fewest leaves that each needs.
struct SolvedCores {
  TakenApart parts;
  std::vector<CsgTree> trees = {};
  std::vector<std::size_t> least_leaves = {};
};

bool is_set(std::span<const std::uint64_t> column, CellIndex cell) {
  return (column[cell / 64] >> (cell % 64) & 1U) != 0;
}

/// A part of the solid whose tree is searched for while the rest stays.
struct ClimbedPart {
  std::vector<PrimitiveIndex> primitives;  // those of its tree, ascending
  std::vector<CellIndex> cells;  // in the solid exactly where they are in the part, or exactly where they are not
  bool is_inverted = false;      // exactly where they are not
  bool is_bounded = false;       // its tree must leave out cells without its primitives
};

/// The cost of the cells of a part's tree, which is over the places in part.primitives.
class PartObjective {
 public:
  PartObjective(const CellComplex& complex, const CellLabels& labels, LabelCosts costs, const ClimbedPart& part,
                double most_evidence)
      : is_inverted_(part.is_inverted), costs_(std::move(costs)), rows_(part.primitives.size()) {
    for (CellIndex row = 0; row < part.cells.size(); ++row) {
      const CellIndex cell = part.cells[row];
      rows_.add(places(complex.cells[cell], part.primitives), false);
      if (labels.evidence[cell] >= most_evidence) costs_.add(row, !labels.is_in[cell], LabelCosts::k_forbidden);
    }
    if (!part.is_bounded) return;
    rows_.add({}, false);
    costs_.add(costs_.add_cell(), !is_inverted_, LabelCosts::k_forbidden);
  }

  [[nodiscard]] double operator()(const CsgTree& tree) const {
    const std::vector<std::uint64_t> holds = evaluate(tree, rows_);
    return costs_.of([&](CellIndex row) { return is_set(holds, row) != is_inverted_; });
  }

  /// Words and cells that an evaluation looks at.
  [[nodiscard]] double work() const { return static_cast<double>(rows_.rows() + costs_.borders().size()); }
  [[nodiscard]] double work_per_node() const { return static_cast<double>(rows_.words()); }

 private:
  /// Places of those of `primitives` that hold the cell.
  static std::vector<PrimitiveIndex> places(const Cell& cell, std::span<const PrimitiveIndex> primitives) {
    std::vector<PrimitiveIndex> result;
    for (PrimitiveIndex place = 0; place < primitives.size(); ++place) {
      if (std::ranges::binary_search(cell, primitives[place])) result.push_back(place);
    }
    return result;
  }

  bool is_inverted_;
  LabelCosts costs_;
  PartialFunction rows_;  // a row for each cell
};

/// Renames the tree's primitives to their places in `primitives`, which has all of them.
CsgTree over_places(const CsgTree& tree, std::span<const PrimitiveIndex> primitives) {
  std::vector<PrimitiveIndex> place(primitives.back() + std::size_t{1});
  for (PrimitiveIndex k = 0; k < primitives.size(); ++k) place[primitives[k]] = k;
  return renumber(tree, place);
}

/// A local search, on the cells instead of points, for a tree whose cells and leaves cost less. Labels that are sure at
/// every limit of options.least_evidence stay, and so do the cells that reach to infinity. Deterministic; a triggered
/// run.stop ends it soon. `costs`: those of the part's cells.
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

  /// The part of a core: the cells where no other core's tree holds.
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

  /// The cores with primitives of a cell; none where a peeled primitive decides the cell.
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

/// The best of the searches over all cells from each of `starts`. Precondition: there is a start.
/// O(size x cells / 64 + cells + patches) an evaluation.
CsgTree climb_as_whole(const CellComplex& complex, const CellLabels& labels, std::span<const CsgTree> starts,
                       const CellSolveOptions& options, const RunContext& run) {
  ClimbedPart part;
  part.primitives.resize(complex.points_of_primitive.size());
  part.cells.resize(complex.cells.size());
  std::iota(part.primitives.begin(), part.primitives.end(), PrimitiveIndex{0});
  std::iota(part.cells.begin(), part.cells.end(), CellIndex{0});
  return climb(complex, labels, LabelCosts(complex, labels.density, labels.options), part, starts, options, run);
}

/// Climbs core by core over the cells that the core decides, while the rest stays: from the core's tree, and from
/// `others`, trees of the whole, restricted to its primitives. Skips cores whose tree is as small as it can be.
/// O(size x cells of the core / 64 + its cells and patches) an evaluation.
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

PartialFunction function_of(const KnownRows& rows, std::size_t variables) {
  PartialFunction function(variables);
  std::vector<PrimitiveIndex> inside;
  for (const bool value : {false, true}) {
    for (const Assignment row : value ? rows.on : rows.off) {
      inside.clear();
      for (PrimitiveIndex p = 0; p < variables; ++p) {
        if ((row >> p & 1U) != 0) inside.push_back(p);
      }
      function.add(inside, value);
    }
  }
  return function;
}

struct Solution {
  CellSolution of_all;
  SolvedCores cores;
};

/// `minimal`: how much work to spend on a formula smaller than that of decompose(); null for none.
void solve_core(const Core& core, const MinimalFormulaOptions* minimal, SolvedCores& cores, const RunContext& run) {
  CsgTree tree = decompose(core.rows, {}, run);
  auto least_leaves = static_cast<std::size_t>(std::popcount(essential_variables(core.rows)));
  if (minimal != nullptr && leaf_count(tree) > least_leaves) {
    const auto smallest = minimal_formula(function_of(core.rows, core.primitives.size()), *minimal, run);
    if (smallest && leaf_count(smallest->tree) < leaf_count(tree)) tree = smallest->tree;
    if (smallest) least_leaves = std::max(least_leaves, smallest->least_leaves);
  }
  cores.trees.push_back(renumber(tree, core.primitives));
  cores.least_leaves.push_back(least_leaves);
}

Solution solve_sure_cells(TakenApart parts, double least_evidence, const MinimalFormulaOptions* minimal,
                          const RunContext& run) {
  Solution solution{.of_all = {.least_evidence = least_evidence}, .cores = {.parts = std::move(parts)}};
  CellSolution& all = solution.of_all;
  SolvedCores& cores = solution.cores;
  for (const Core& core : cores.parts.cores) {
    solve_core(core, minimal, cores, run);
    all.cores.push_back(core.primitives.size());
  }
  for (const PeeledRound& round : cores.parts.rounds) all.peeled += round.primitives.size();
  // Each core needs its leaves, each peeled primitive one. But other choices of what to leave out may need fewer.
  all.least_leaves = std::accumulate(cores.least_leaves.begin(), cores.least_leaves.end(), all.peeled);
  if (!cores.parts.needs_its_parts()) all.least_leaves = cores.parts.least_leaves();
  all.tree = put_together(cores.parts, cores.trees);
  return solution;
}

/// Whether all sure cells are as labelled.
bool has_labels(const std::vector<bool>& is_in, const CellLabels& labels, double least_evidence) {
  for (std::size_t cell = 0; cell < is_in.size(); ++cell) {
    if (labels.evidence[cell] >= least_evidence && is_in[cell] != labels.is_in[cell]) return false;
  }
  return true;
}

class CellSolver {
 public:
  CellSolver(const CellComplex& complex, const CellLabels& labels, const CellSolveOptions& options,
             const RunContext& run)
      : complex_(complex), labels_(labels), options_(options), run_(run) {}

  std::optional<CellSolution> solve() {
    try_limits();
    if (!best_) return std::nullopt;
    note("decomposition");
    const double least_evidence = best_->of_all.least_evidence;
    // Without cores a minimal formula has nothing to replace.
    if (!is_as_small_as_can_be() && !best_->of_all.cores.empty()) {
      try_with(least_evidence, &options_.minimal);
      note("minimal formulas");
    }
    if (!is_as_small_as_can_be() && !best_->cores.parts.needs_its_parts()) prove_without_choices(least_evidence);
    if (!is_as_cheap_as_can_be() && options_.climb.work_limit > 0) {
      climb();
      note("climbing");
    }
    CellSolution result = std::move(best_->of_all);
    result.tree = with_few_levels(result.tree, complex_);
    result.is_complete = result.is_minimal() || !run_.stop.stop_requested();
    for (CellIndex cell = 0; cell < complex_.cells.size(); ++cell) {
      if (labels_.evidence[cell] < least_evidence) result.open_cells.push_back(cell);
    }
    result.steps = std::move(steps_);
    return result;
  }

 private:
  void try_limits() {
    std::size_t sure = complex_.cells.size() + 1;
    for (const double least_evidence : options_.least_evidence) {
      const auto as_sure = static_cast<std::size_t>(std::ranges::count_if(
          labels_.evidence, [least_evidence](double evidence) { return evidence >= least_evidence; }));
      if (as_sure == sure) continue;  // the same cells as before
      sure = as_sure;
      try_with(least_evidence, nullptr);
      if (!best_) continue;
      // More sure cells need no fewer leaves, and no labels cost less than those of the cut.
      const double bound = labels_.cost + price_of(best_->of_all.least_leaves.value());
      if (total(best_->of_all) <= bound + 1e-9) break;
    }
  }

  void try_with(double least_evidence, const MinimalFormulaOptions* minimal) {
    std::optional<TakenApart> parts = take_apart(complex_, labels_, least_evidence);
    if (!parts) return;
    Solution solution = solve(std::move(*parts), least_evidence, minimal);
    if (!best_ || total(solution.of_all) <= total(best_->of_all)) best_ = std::move(solution);
  }

  /// solve_sure_cells(), with the cost of the tree.
  Solution solve(TakenApart parts, double least_evidence, const MinimalFormulaOptions* minimal) {
    Solution solution = solve_sure_cells(std::move(parts), least_evidence, minimal, run_);
    CellSolution& all = solution.of_all;
    if (std::ranges::find(tried_, all.tree) == tried_.end()) tried_.push_back(all.tree);
    all.cost = cost_of(complex_, cells_in(all.tree, complex_), labels_.density, labels_.options);
    return solution;
  }

  /// Other primitives might have been left out: only what all cells over all primitives need is proved.
  void prove_without_choices(double least_evidence) {
    std::optional<TakenApart> parts = take_apart_only(complex_, labels_, least_evidence);
    if (!parts || !parts->needs_its_parts() || !std::ranges::all_of(parts->cores, is_small)) return;
    Solution solution = solve(std::move(*parts), least_evidence, &options_.minimal);
    const std::optional<std::size_t> least = solution.of_all.least_leaves;
    // Equal is not enough: its choice for the open cells is as arbitrary.
    if (total(solution.of_all) < total(best_->of_all)) best_ = std::move(solution);
    CellSolution& best = best_->of_all;
    if (best.least_evidence == least_evidence) best.least_leaves = std::max(best.least_leaves, least);
    note("minimal formulas over all");
  }

  /// For the search of a minimal formula, which gives no bound for larger cores.
  static bool is_small(const Core& core) {
    constexpr std::size_t k_most_rows = 512;
    return core.rows.on.size() + core.rows.off.size() <= k_most_rows;
  }

  /// Climbs over all primitives at once if they are few; else core by core, without moves between cores.
  void climb() {
    const bool is_small = complex_.points_of_primitive.size() <= k_most_variables;
    CellSolution climbed = best_->of_all;
    climbed.tree = is_small ? climb_as_whole(complex_, labels_, tried_, options_, run_)
                            : climb_core_by_core(complex_, labels_, best_->cores, tried_, options_, run_);
    const std::vector<bool> is_in = cells_in(climbed.tree, complex_);
    climbed.cost = cost_of(complex_, is_in, labels_.density, labels_.options);
    if (total(climbed) >= total(best_->of_all)) return;
    if (!has_labels(is_in, labels_, climbed.least_evidence)) climbed.least_leaves.reset();
    best_->of_all = std::move(climbed);
  }

  [[nodiscard]] bool is_as_small_as_can_be() const {
    return is_constant(best_->of_all.tree) || best_->of_all.is_minimal();
  }
  /// Whether the best is within a leaf of the least cost: no labels cost less than those of the cut.
  [[nodiscard]] bool is_as_cheap_as_can_be() const {
    const CellSolution& best = best_->of_all;
    return is_constant(best.tree) || (best.is_minimal() && best.cost < labels_.cost + options_.leaf_cost);
  }
  [[nodiscard]] double price_of(std::size_t leaves) const { return options_.leaf_cost * static_cast<double>(leaves); }
  [[nodiscard]] double total(const CellSolution& of) const { return of.cost + price_of(leaf_count(of.tree)); }
  void note(const char* step) { steps_.push_back({step, best_->of_all.tree.size()}); }

  const CellComplex& complex_;
  const CellLabels& labels_;
  const CellSolveOptions& options_;
  const RunContext& run_;
  std::optional<Solution> best_;
  std::vector<CsgTree> tried_;
  std::vector<TreeStep> steps_;
};

}  // namespace

std::optional<OptionConflict> conflict_in(const CellSolveOptions& options) {
  const std::vector<double>& least = options.least_evidence;
  if (!least.empty() && std::ranges::is_sorted(least, std::greater<>())) return std::nullopt;
  return OptionConflict{"least_evidence",
                        least.empty() ? "expected at least one number" : "expected descending numbers"};
}

std::optional<CellSolution> solve_cells(const CellComplex& complex, const CellLabels& labels,
                                        const CellSolveOptions& options, const RunContext& run) {
  return CellSolver(complex, labels, options, run).solve();
}

}  // namespace cloud2csg
