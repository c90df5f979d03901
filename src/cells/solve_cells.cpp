#include <algorithm>
#include <bit>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "cells/cell_hash.hpp"
#include "cells/decompose.hpp"
#include "cloud2csg/cells.hpp"
#include "cloud2csg/restrict.hpp"
#include "cloud2csg/simplify.hpp"

namespace cloud2csg {
namespace {

Cell without(const Cell& cell, PrimitiveIndex primitive) {
  Cell rest = cell;
  std::erase(rest, primitive);
  return rest;
}

/// A cell of which it is sure whether it is in the solid.
struct KnownCell {
  Cell cell;
  bool is_in = false;
  bool is_open = true;  ///< no primitive that was split off decides it
};

/// The sure cells, without primitives on which no label depends.
class KnownCells {
 public:
  /// Where the cell outside of all is in, all labels are taken for their opposite.
  KnownCells(const CellComplex& complex, const CellLabels& labels, double least_evidence)
      : cells_of_(complex.points_of_primitive.size()), index_(complex.cells.size(), Hash{this}, Equal{this}) {
    for (CellIndex c = 0; c < complex.cells.size(); ++c) {
      if (labels.evidence[c] < least_evidence) continue;
      for (const PrimitiveIndex p : complex.cells[c]) cells_of_[p].push_back(cells_.size());
      cells_.push_back({complex.cells[c], labels.is_in[c] != labels.is_in.front()});
    }
    for (std::size_t c = 0; c < cells_.size(); ++c) index_.insert(c);
    std::vector<bool> is_essential(cells_of_.size());
    for (PrimitiveIndex p = 0; p < cells_of_.size(); ++p) is_essential[p] = is_needed(p);
    essential_ = static_cast<std::size_t>(std::ranges::count(is_essential, true));
    // Those stay so, whatever else is left out.
    for (const PrimitiveIndex p : least_seen_first(complex)) {
      if (!is_essential[p] && !is_needed(p)) leave_out(p);
    }
  }
  KnownCells(const KnownCells&) = delete;
  KnownCells& operator=(const KnownCells&) = delete;
  KnownCells(KnownCells&&) = delete;
  KnownCells& operator=(KnownCells&&) = delete;
  ~KnownCells() = default;

  /// Leaves none behind.
  [[nodiscard]] std::vector<KnownCell> take_sorted() {
    std::erase_if(cells_, [](const KnownCell& known) { return !known.is_open; });
    std::ranges::sort(cells_, {}, &KnownCell::cell);
    return std::move(cells_);
  }

  /// How many primitives any tree needs.
  [[nodiscard]] std::size_t essential() const { return essential_; }
  /// Whether that is all that have cells.
  [[nodiscard]] bool are_all_essential() const { return left_out_ == 0; }

 private:
  /// The index holds places in cells_, and is asked for cells.
  struct Hash {
    using is_transparent = void;
    const KnownCells* known;
    std::size_t operator()(std::size_t place) const { return CellHash()(known->cells_[place].cell); }
    std::size_t operator()(const Cell& cell) const { return CellHash()(cell); }
  };
  struct Equal {
    using is_transparent = void;
    const KnownCells* known;
    bool operator()(std::size_t a, std::size_t b) const { return known->cells_[a].cell == known->cells_[b].cell; }
    bool operator()(std::size_t place, const Cell& cell) const { return known->cells_[place].cell == cell; }
    bool operator()(const Cell& cell, std::size_t place) const { return known->cells_[place].cell == cell; }
  };

  /// By the points on the patches between a cell that they hold and one that they do not.
  static std::vector<PrimitiveIndex> least_seen_first(const CellComplex& complex) {
    std::vector<double> seen(complex.points_of_primitive.size());
    Cell between;
    for (const Patch& patch : complex.patches) {
      between.clear();
      std::ranges::set_symmetric_difference(complex.cells[patch.first], complex.cells[patch.second],
                                            std::back_inserter(between));
      for (const PrimitiveIndex p : between) seen[p] += patch.first_in + patch.second_in;
    }
    std::vector<PrimitiveIndex> order(seen.size());
    std::iota(order.begin(), order.end(), PrimitiveIndex{0});
    std::ranges::stable_sort(order, {}, [&seen](PrimitiveIndex p) { return seen[p]; });
    return order;
  }

  /// Whether two cells differ in nothing but the primitive, and in their label.
  [[nodiscard]] bool is_needed(PrimitiveIndex p) const {
    return std::ranges::any_of(cells_of_[p], [&](std::size_t c) {
      if (!cells_[c].is_open) return false;
      const auto other = index_.find(without(cells_[c].cell, p));
      return other != index_.end() && cells_[*other].is_in != cells_[c].is_in;
    });
  }

  void leave_out(PrimitiveIndex p) {
    left_out_ += cells_of_[p].empty() ? 0 : 1;
    for (const std::size_t c : cells_of_[p]) {
      if (!cells_[c].is_open) continue;
      index_.erase(index_.find(c));
      std::erase(cells_[c].cell, p);
      // Not open: it has become the same as another.
      cells_[c].is_open = index_.insert(c).second;
    }
  }

  std::vector<KnownCell> cells_;
  std::vector<std::vector<std::size_t>> cells_of_;  // by primitive
  std::unordered_set<std::size_t, Hash, Equal> index_;
  std::size_t essential_ = 0, left_out_ = 0;
};

/// Splits off what is wholly in, or wholly out.
class Peeler {
 public:
  Peeler(std::vector<KnownCell> cells, std::size_t primitives)
      : cells_(std::move(cells)), cells_of_(primitives), in_(primitives), out_(primitives) {
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      for (const PrimitiveIndex p : cells_[c].cell) {
        cells_of_[p].push_back(c);
        ++(cells_[c].is_in ? in_ : out_)[p];
      }
    }
  }

  /// Primitives that were split off at once: all united with the rest, or all taken from it.
  struct Round {
    bool are_in;
    std::vector<PrimitiveIndex> primitives;
  };

  /// What is split off first stands outermost. Differences first.
  [[nodiscard]] std::vector<Round> peel() {
    std::vector<Round> rounds;
    bool are_in = false;
    for (int idle = 0; idle < 2; are_in = !are_in) {
      Round round{.are_in = are_in, .primitives = {}};
      for (const PrimitiveIndex p : candidates(are_in)) {
        // One whose cells have all been decided meanwhile is not needed.
        if ((are_in ? in_ : out_)[p] == 0) continue;
        round.primitives.push_back(p);
        close_cells_of(p);
      }
      std::ranges::sort(round.primitives);
      idle = round.primitives.empty() ? idle + 1 : 0;
      if (!round.primitives.empty()) rounds.push_back(std::move(round));
    }
    return rounds;
  }

  [[nodiscard]] const std::vector<KnownCell>& cells() const { return cells_; }

 private:
  /// Those with most cells first: they may decide those of others.
  [[nodiscard]] std::vector<PrimitiveIndex> candidates(bool are_in) const {
    const std::vector<std::size_t>& right = are_in ? in_ : out_;
    const std::vector<std::size_t>& wrong = are_in ? out_ : in_;
    std::vector<PrimitiveIndex> found;
    for (PrimitiveIndex p = 0; p < cells_of_.size(); ++p) {
      if (right[p] > 0 && wrong[p] == 0) found.push_back(p);
    }
    std::ranges::stable_sort(found, std::greater<>(), [&right](PrimitiveIndex p) { return right[p]; });
    return found;
  }

  void close_cells_of(PrimitiveIndex p) {
    for (const std::size_t c : cells_of_[p]) {
      KnownCell& known = cells_[c];
      if (!known.is_open) continue;
      known.is_open = false;
      for (const PrimitiveIndex other : known.cell) --(known.is_in ? in_ : out_)[other];
    }
  }

  std::vector<KnownCell> cells_;
  std::vector<std::vector<std::size_t>> cells_of_;  // by primitive
  std::vector<std::size_t> in_, out_;               // by primitive: open cells with it
};

/// Open cells that share primitives, and these.
struct Core {
  std::vector<PrimitiveIndex> primitives;  ///< ascending
  std::vector<const KnownCell*> cells;
};

std::vector<Core> cores_of(const std::vector<KnownCell>& cells, std::size_t primitives) {
  std::vector<PrimitiveIndex> leader(primitives);
  std::iota(leader.begin(), leader.end(), PrimitiveIndex{0});
  const auto find = [&leader](PrimitiveIndex p) {
    while (leader[p] != p) p = leader[p] = leader[leader[p]];
    return p;
  };
  std::vector<bool> is_used(primitives, false);
  for (const KnownCell& known : cells) {
    if (!known.is_open || known.cell.empty()) continue;
    for (const PrimitiveIndex p : known.cell) {
      is_used[p] = true;
      leader[find(p)] = find(known.cell.front());
    }
  }
  std::vector<Core> cores;
  std::unordered_map<PrimitiveIndex, std::size_t> place;
  for (PrimitiveIndex p = 0; p < primitives; ++p) {
    if (!is_used[p]) continue;
    const auto [found, is_new] = place.try_emplace(find(p), cores.size());
    if (is_new) cores.emplace_back();
    cores[found->second].primitives.push_back(p);
  }
  for (const KnownCell& known : cells) {
    if (known.is_open && !known.cell.empty()) cores[place.at(find(known.cell.front()))].cells.push_back(&known);
  }
  return cores;
}

KnownRows rows_of(const Core& core) {
  KnownRows rows{.on = {}, .off = {0}};
  for (const KnownCell* known : core.cells) {
    Assignment row = 0;
    for (const PrimitiveIndex p : known->cell) {
      const auto place = std::ranges::lower_bound(core.primitives, p) - core.primitives.begin();
      row |= Assignment{1} << static_cast<std::size_t>(place);
    }
    (known->is_in ? rows.on : rows.off).push_back(row);
  }
  return rows;
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

/// A formula over the primitives, and how many leaves it needs at least.
struct CoreSolution {
  CsgTree tree;
  std::size_t least_leaves;
};

/// `minimal`: how much work to spend on a formula that is smaller than what decompose() finds.
CoreSolution solve_core(const Core& core, const MinimalFormulaOptions* minimal, const RunContext& run) {
  const KnownRows rows = rows_of(core);
  CoreSolution solution{decompose(rows, {}, run), static_cast<std::size_t>(std::popcount(essential_variables(rows)))};
  if (minimal != nullptr && leaf_count(solution.tree) > solution.least_leaves) {
    const auto smallest = minimal_formula(function_of(rows, core.primitives.size()), *minimal, run);
    if (smallest && leaf_count(smallest->tree) < leaf_count(solution.tree)) solution.tree = smallest->tree;
    if (smallest) solution.least_leaves = std::max(solution.least_leaves, smallest->least_leaves);
  }
  solution.tree = renumber(solution.tree, core.primitives);
  return solution;
}

std::vector<CsgTree> leaves(const std::vector<PrimitiveIndex>& primitives) {
  std::vector<CsgTree> trees;
  trees.reserve(primitives.size());
  for (const PrimitiveIndex p : primitives) trees.push_back(CsgTree::leaf(p));
  return trees;
}

std::optional<CellSolution> solve_sure_cells(const CellComplex& complex, const CellLabels& labels,
                                             double least_evidence, const MinimalFormulaOptions* minimal,
                                             const RunContext& run) {
  KnownCells known(complex, labels, least_evidence);
  const std::size_t primitives = complex.points_of_primitive.size();
  Peeler peeler(known.take_sorted(), primitives);
  std::vector<Peeler::Round> rounds = peeler.peel();
  CellSolution solution{.least_evidence = least_evidence};
  std::vector<CsgTree> trees;
  const std::vector<Core> cores = cores_of(peeler.cells(), primitives);
  const auto is_too_large = [](const Core& core) { return core.primitives.size() > k_most_variables; };
  if (std::ranges::any_of(cores, is_too_large)) return std::nullopt;
  for (const Core& core : cores) {
    solution.cores.push_back(core.primitives.size());
    CoreSolution solved = solve_core(core, minimal, run);
    solution.least_leaves += solved.least_leaves;
    trees.push_back(std::move(solved.tree));
  }
  CsgTree tree = unite_all(trees);
  std::ranges::reverse(rounds);
  for (const Peeler::Round& round : rounds) {
    const CsgTree split = unite_all(leaves(round.primitives));
    solution.peeled += round.primitives.size();
    tree = round.are_in ? unite(tree, split) : subtract(tree, split);
  }
  // Each core needs its leaves, and what was split off one each; but other choices of what to leave out may need fewer.
  solution.least_leaves += solution.peeled;
  if (!known.are_all_essential()) solution.least_leaves = known.essential();
  solution.tree = simplify(labels.is_in.front() ? complement(tree) : tree);
  return solution;
}

/// Which cells are in a tree. O(size of all cells x log of the tree's size)
std::vector<bool> cells_in(const CsgTree& tree, const CellComplex& complex) {
  const TreeRestriction restriction(tree);
  const std::vector<bool> everywhere(complex.points_of_primitive.size(), true);
  std::vector<bool> result;
  result.reserve(complex.cells.size());
  for (const Cell& cell : complex.cells) result.push_back(contains(restriction.restrict_to(cell), everywhere));
  return result;
}

}  // namespace

std::optional<CellSolution> solve_cells(const CellComplex& complex, const CellLabels& labels,
                                        const CellSolveOptions& options, const RunContext& run) {
  std::optional<CellSolution> best;
  const auto total = [&options](const CellSolution& of) {
    return of.cost + options.leaf_cost * static_cast<double>(leaf_count(of.tree));
  };
  const auto try_with = [&](double least_evidence, const MinimalFormulaOptions* minimal) {
    std::optional<CellSolution> solution = solve_sure_cells(complex, labels, least_evidence, minimal, run);
    if (!solution) return;
    solution->cost = cost_of(complex, cells_in(solution->tree, complex), labels.density, labels.options);
    if (!best || total(*solution) <= total(*best)) best = std::move(solution);
  };
  std::size_t sure = complex.cells.size() + 1;
  for (const double least_evidence : options.least_evidence) {
    const auto as_sure = static_cast<std::size_t>(std::ranges::count_if(
        labels.evidence, [least_evidence](double evidence) { return evidence >= least_evidence; }));
    if (as_sure == sure) continue;  // the same cells as before
    sure = as_sure;
    try_with(least_evidence, nullptr);
    // More cells that are sure need no fewer leaves, and no labels cost less than those of the cut.
    if (best && total(*best) <= labels.cost + options.leaf_cost * static_cast<double>(best->least_leaves) + 1e-9) break;
  }
  if (!best) return best;
  const double least = best->least_evidence;
  // Without cores there is nothing that a minimal formula could replace.
  if (!best->is_minimal() && !best->cores.empty()) try_with(least, &options.minimal);
  best->is_complete = best->is_minimal() || !run.stop.stop_requested();
  for (CellIndex cell = 0; cell < complex.cells.size(); ++cell) {
    if (labels.evidence[cell] < least) best->open_cells.push_back(cell);
  }
  return best;
}

}  // namespace cloud2csg
