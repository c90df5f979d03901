#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>
#include <utility>

#include "cells/climb_on_cells.hpp"
#include "cells/few_levels.hpp"
#include "cells/take_apart.hpp"
#include "cells/tree_cells.hpp"
#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {
namespace {

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

/// A tree, and what it is made of.
struct Solution {
  CellSolution of_all;
  SolvedCores cores;
};

/// `minimal`: how much work to spend on a formula that is smaller than what decompose() finds.
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
  // Each core needs its leaves, and what was split off one each; but other choices of what to leave out may need fewer.
  all.least_leaves = std::accumulate(cores.least_leaves.begin(), cores.least_leaves.end(), all.peeled);
  if (!cores.parts.needs_its_parts()) all.least_leaves = cores.parts.least_leaves();
  all.tree = put_together(cores.parts, cores.trees);
  return solution;
}

/// Whether all cells that are sure are as labelled.
bool has_labels(const std::vector<bool>& is_in, const CellLabels& labels, double least_evidence) {
  for (std::size_t cell = 0; cell < is_in.size(); ++cell) {
    if (labels.evidence[cell] >= least_evidence && is_in[cell] != labels.is_in[cell]) return false;
  }
  return true;
}

/// Tries what there is to try, and keeps the best.
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
    // Without cores there is nothing that a minimal formula could replace.
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
      // More cells that are sure need no fewer leaves, and no labels cost less than those of the cut.
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

  /// With what it costs.
  Solution solve(TakenApart parts, double least_evidence, const MinimalFormulaOptions* minimal) {
    Solution solution = solve_sure_cells(std::move(parts), least_evidence, minimal, run_);
    CellSolution& all = solution.of_all;
    if (std::ranges::find(tried_, all.tree) == tried_.end()) tried_.push_back(all.tree);
    all.cost = cost_of(complex_, cells_in(all.tree, complex_), labels_.density, labels_.options);
    return solution;
  }

  /// Where primitives were left out, others might have been: only what all cells over all primitives need is proved.
  void prove_without_choices(double least_evidence) {
    std::optional<TakenApart> parts = take_apart_only(complex_, labels_, least_evidence);
    if (!parts || !parts->needs_its_parts() || !std::ranges::all_of(parts->cores, is_small)) return;
    Solution solution = solve(std::move(*parts), least_evidence, &options_.minimal);
    const std::optional<std::size_t> least = solution.of_all.least_leaves;
    // As good is not enough: what it makes of the cells that are open is as arbitrary.
    if (total(solution.of_all) < total(best_->of_all)) best_ = std::move(solution);
    CellSolution& best = best_->of_all;
    if (best.least_evidence == least_evidence) best.least_leaves = std::max(best.least_leaves, least);
    note("minimal formulas over all");
  }

  /// For the search of a minimal formula, which has no bound to give otherwise.
  static bool is_small(const Core& core) {
    constexpr std::size_t k_most_rows = 512;
    return core.rows.on.size() + core.rows.off.size() <= k_most_rows;
  }

  /// Over all primitives at once where they are few; where they are not, no move from core to core is tried.
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
  /// But for less than a leaf: no labels cost less than those of the cut.
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
