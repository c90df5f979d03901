#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cells/formula_tables.hpp"
#include "cloud2csg/advanced/formula.hpp"
#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {
namespace {

/// A partial function without redundancy: each assignment once, no variable that is constant, and only the first of
/// variables that are equal or complementary in all rows.
struct ReducedFunction {
  std::vector<PrimitiveIndex> variables;       ///< ascending
  std::vector<std::vector<bool>> assignments;  ///< by row: whether each of the variables is true; distinct, ascending
  std::vector<bool> values;                    ///< by row
};

/// Two rows of a reduced function whose assignments differ in one variable.
struct RowPair {
  std::size_t row_without;
  std::size_t row_with;
};

/// Whether two variables are equal in all rows, or complementary in all rows.
bool are_interchangeable(const PartialFunction& function, PrimitiveIndex a, PrimitiveIndex b) {
  const bool differ = function.is_true(0, a) != function.is_true(0, b);
  for (std::size_t row = 1; row < function.rows(); ++row) {
    if ((function.is_true(row, a) != function.is_true(row, b)) != differ) return false;
  }
  return true;
}

bool is_constant(const PartialFunction& function, PrimitiveIndex variable) {
  for (std::size_t row = 1; row < function.rows(); ++row) {
    if (function.is_true(row, variable) != function.is_true(0, variable)) return false;
  }
  return true;
}

/// O(variables^2 x rows + rows x log rows x variables)
ReducedFunction reduce(const PartialFunction& function) {
  ReducedFunction reduced;
  for (PrimitiveIndex v = 0; v < function.variables(); ++v) {
    const auto same = [&function, v](PrimitiveIndex other) { return are_interchangeable(function, v, other); };
    if (is_constant(function, v) || std::ranges::any_of(reduced.variables, same)) continue;
    reduced.variables.push_back(v);
  }
  std::map<std::vector<bool>, bool> rows;
  for (std::size_t row = 0; row < function.rows(); ++row) {
    std::vector<bool> assignment(reduced.variables.size());
    for (std::size_t i = 0; i < assignment.size(); ++i) assignment[i] = function.is_true(row, reduced.variables[i]);
    rows.emplace(std::move(assignment), function.value(row));
  }
  for (const auto& [assignment, value] : rows) {
    reduced.assignments.push_back(assignment);
    reduced.values.push_back(value);
  }
  return reduced;
}

/// All row pairs, by variable. Where the values of a pair differ, each formula has the variable: plain when the value
/// rises with it, complemented when it falls, twice when there are both. O(rows x log rows x variables^2)
std::vector<std::vector<RowPair>> neighbours(const ReducedFunction& function) {
  std::vector<std::vector<RowPair>> pairs(function.variables.size());
  for (std::size_t row = 0; row < function.assignments.size(); ++row) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      std::vector<bool> assignment = function.assignments[row];
      if (assignment[i]) continue;
      assignment[i] = true;
      const auto place = std::ranges::lower_bound(function.assignments, assignment);
      if (place == function.assignments.end() || *place != assignment) continue;
      pairs[i].push_back(
          {.row_without = row, .row_with = static_cast<std::size_t>(place - function.assignments.begin())});
    }
  }
  return pairs;
}

/// Formulas of as few leaves as possible, for a reduced function of at most 64 x Words rows that is not constant.
/// Functions of few leaves are listed bottom up. Larger formulas are split top down: a function, or its complement, is
/// a conjunction of two functions. Both are true wherever the function is, which most listed ones are not, and no row
/// may be true in both but not in the function. Where the larger one is not listed, the smaller one is. The larger is
/// then searched for in the same way, free in the rows where the smaller is false.
template <std::size_t Words>
class FormulaSearch {
 public:
  using Rows = RowSet<Words>;

  FormulaSearch(const ReducedFunction& function, const MinimalFormulaOptions& options, const RunContext& run)
      : options_(options),
        budget_(options.combination_limit, run.stop),
        neighbours_(neighbours(function)),
        target_(target_of(function)),
        tables_(target_.care) {
    for (std::size_t i = 0; i < function.variables.size(); ++i) {
      Rows column;
      for (std::size_t row = 0; row < function.values.size(); ++row) {
        if (function.assignments[row][i]) column.insert(row);
      }
      tables_.add_variable(function.variables[i], column);
    }
  }

  /// Tries numbers of leaves upwards, so that the first formula found is a smallest one.
  MinimalFormula solve() {
    for (std::size_t leaves = least_leaves(target_);; ++leaves) {
      list_functions(leaves);
      const std::optional<SignedFormula> found = find(target_, leaves);
      if (found) return {.tree = tree_of(*found), .is_minimal = true, .least_leaves = leaves};
      if (budget_.is_exhausted() || leaves > most_leaves()) return solve_without_proof(leaves);
    }
  }

 private:
  /// What a formula must be: true in the rows `on`, false in the other rows of `care`.
  struct Target {
    Rows care;
    Rows on;
    friend bool operator==(const Target&, const Target&) = default;
    [[nodiscard]] Rows off() const { return care - on; }
    [[nodiscard]] Target negated() const { return {care, off()}; }
  };
  struct TargetHash {
    std::size_t operator()(const Target& target) const {
      return target.care.hash() + 0x9e3779b97f4a7c15ULL * target.on.hash();
    }
  };
  struct Listed {
    std::size_t index;
    bool is_negated;
  };
  /// Functions that are true wherever a target is. Excess: rows where a function is true and the target is not.
  struct Candidates {
    std::vector<Listed> functions;
    std::vector<Rows> excess;
  };

  /// A function that is true wherever a target is, as a part of a conjunction.
  struct Settling {
    Listed function{};
    Rows excess{};
    std::size_t rows = 0;  ///< rows where both the target and the function are false
    std::size_t leaves = 1;

    [[nodiscard]] bool settles_more_than(const Settling& other) const {
      return rows * other.leaves > other.rows * leaves;
    }
  };

  static Target target_of(const ReducedFunction& function) {
    Target target;
    for (std::size_t row = 0; row < function.values.size(); ++row) {
      target.care.insert(row);
      if (function.values[row]) target.on.insert(row);
    }
    return target;
  }

  static CsgTree tree_of(const SignedFormula& formula) {
    return simplify(formula.is_complemented ? complement(formula.tree) : formula.tree);
  }

  bool spend(std::size_t combinations) { return budget_.spend(std::uint64_t{combinations} * Words); }

  [[nodiscard]] SignedFormula formula(const Listed& function) const {
    return tables_.formula(function.index).negated_if(function.is_negated);
  }

  /// For when not all formulas of `least` leaves were looked at. The search may still find a small one.
  MinimalFormula solve_without_proof(std::size_t least) {
    CsgTree tree = tree_of(approximate(target_));
    for (std::size_t leaves = least + 1; leaves < leaf_count(tree) && !budget_.is_exhausted(); ++leaves) {
      const std::optional<SignedFormula> found = find(target_, leaves);
      if (found) tree = tree_of(*found);
    }
    const bool is_minimal = leaf_count(tree) == least;
    return {.tree = std::move(tree), .is_minimal = is_minimal, .least_leaves = least};
  }

  /// Lists what a search for `leaves` leaves needs, and more as long as that is cheap: it shortens the search.
  void list_functions(std::size_t leaves) {
    while (can_list_ && tables_.levels() + 1 < leaves &&
           (leaves > most_leaves() || tables_.next_level_work() <= k_cheap_work)) {
      can_list_ = tables_.add_level(options_.table_limit, budget_);
    }
  }

  /// Up to this many leaves the search is complete: the smaller part of a formula is listed.
  [[nodiscard]] std::size_t most_leaves() const { return 2 * tables_.levels() + 1; }

  /// A lower bound, from rows that differ in one variable only.
  [[nodiscard]] std::size_t least_leaves(const Target& target) const {
    std::size_t leaves = 0;
    const Rows off = target.off();
    for (const std::vector<RowPair>& pairs : neighbours_) {
      bool rises = false;
      bool falls = false;
      for (const RowPair& pair : pairs) {
        rises = rises || (off.contains(pair.row_without) && target.on.contains(pair.row_with));
        falls = falls || (target.on.contains(pair.row_without) && off.contains(pair.row_with));
      }
      leaves += static_cast<std::size_t>(rises) + static_cast<std::size_t>(falls);
    }
    return std::max<std::size_t>(leaves, 1);
  }

  /// A formula of so many leaves. Precondition, here and below: none of fewer will do, or nothing is to be proved.
  /// Absent also when the budget ends.
  std::optional<SignedFormula> find(const Target& target, std::size_t leaves) {
    if (leaves == 1) return find_listed(target, 1);
    if (!spend(k_target_work) || least_leaves(target) > leaves) return {};
    const auto known = refuted_.find(target);
    if (known != refuted_.end() && known->second >= leaves) return {};
    std::optional<SignedFormula> found = find_conjunction(target, leaves);
    if (!found) {
      found = find_conjunction(target.negated(), leaves);
      if (found) return std::move(*found).negated_if(true);
    }
    if (!found && !budget_.is_exhausted()) refuted_[target] = leaves;
    return found;
  }

  std::optional<SignedFormula> find_listed(const Target& target, std::size_t leaves) const {
    const std::span<const Rows> level = tables_.level(leaves);
    for (std::size_t i = 0; i < level.size(); ++i) {
      const Rows rows = level[i] & target.care;
      const bool is_negated = rows == target.off();
      if (is_negated || rows == target.on) return formula({tables_.level_begin(leaves) + i, is_negated});
    }
    return {};
  }

  std::optional<SignedFormula> find_conjunction(const Target& target, std::size_t leaves) {
    const std::size_t least = leaves > tables_.levels() ? leaves - tables_.levels() : 1;
    for (std::size_t less = least; less <= leaves / 2; ++less) {
      std::optional<SignedFormula> found = find_pair(target, leaves - less, less);
      if (found || budget_.is_exhausted()) return found;
    }
    for (std::size_t less = 1; less < least && less <= std::min(leaves / 2, tables_.levels()); ++less) {
      std::optional<SignedFormula> found = find_with_listed(target, leaves - less, less);
      if (found || budget_.is_exhausted()) return found;
    }
    return {};
  }

  /// A conjunction of two listed functions.
  std::optional<SignedFormula> find_pair(const Target& target, std::size_t more, std::size_t less) {
    if (!spend(tables_.level(less).size())) return {};
    const Candidates first = candidates(target, less);
    if (first.excess.empty() || !spend(tables_.level(more).size())) return {};
    const Candidates second = candidates(target, more);
    for (std::size_t a = 0; a < first.excess.size(); ++a) {
      if (!spend(second.excess.size())) return {};
      const Rows excess = first.excess[a];
      const auto fits = [&excess](const Rows& other) { return are_disjoint(excess, other); };
      const auto b = std::ranges::find_if(second.excess, fits);
      if (b == second.excess.end()) continue;
      const auto place = static_cast<std::size_t>(b - second.excess.begin());
      return conjunction(formula(first.functions[a]), formula(second.functions[place]));
    }
    return {};
  }

  std::optional<SignedFormula> find_with_listed(const Target& target, std::size_t more, std::size_t less) {
    if (!spend(tables_.level(less).size())) return {};
    const Candidates first = candidates(target, less);
    for (std::size_t a = 0; a < first.excess.size() && !budget_.is_exhausted(); ++a) {
      const Rows care = target.on | first.excess[a];
      if (care == target.care) continue;
      const std::optional<SignedFormula> rest = find({care, target.on}, more);
      if (rest) return conjunction(*rest, formula(first.functions[a]));
    }
    return {};
  }

  /// Candidates among the listed functions of `leaves` leaves and their complements.
  [[nodiscard]] Candidates candidates(const Target& target, std::size_t leaves) const {
    Candidates chosen;
    const std::span<const Rows> level = tables_.level(leaves);
    const Rows off = target.off();
    for (std::size_t i = 0; i < level.size(); ++i) {
      const bool is_negated = are_disjoint(target.on, level[i]);
      if (!is_negated && !is_within(target.on, level[i])) continue;
      chosen.excess.push_back(is_negated ? off - level[i] : off & level[i]);
      chosen.functions.push_back({tables_.level_begin(leaves) + i, is_negated});
    }
    return chosen;
  }

  /// Some formula, mostly small: a listed one if it will do, else a conjunction with the listed function that settles
  /// most rows for each of its leaves, else a split by a variable. Precondition: on and off are not empty.
  [[nodiscard]] SignedFormula approximate(const Target& target) const {
    for (std::size_t leaves = 1; leaves <= tables_.levels(); ++leaves) {
      std::optional<SignedFormula> found = find_listed(target, leaves);
      if (found) return std::move(*found);
    }
    const Settling plain = most_settling(target);
    const Settling negated = most_settling(target.negated());
    if (!plain.settles_more_than({}) && !negated.settles_more_than({})) return split(target);
    const bool negate = negated.settles_more_than(plain);
    const Settling& chosen = negate ? negated : plain;
    const Target part = negate ? target.negated() : target;
    return conjunction(approximate({part.on | chosen.excess, part.on}), formula(chosen.function)).negated_if(negate);
  }

  [[nodiscard]] Settling most_settling(const Target& target) const {
    Settling best;
    const std::size_t off = target.off().size();
    for (std::size_t leaves = 1; leaves <= tables_.levels(); ++leaves) {
      const Candidates found = candidates(target, leaves);
      for (std::size_t i = 0; i < found.excess.size(); ++i) {
        const Settling other{found.functions[i], found.excess[i], off - found.excess[i].size(), leaves};
        if (other.settles_more_than(best)) best = other;
      }
    }
    return best;
  }

  /// Splits by the variable that leaves least to do. Precondition: no listed function settles anything, so each
  /// variable that varies within the rows does so in those on and in those off.
  [[nodiscard]] SignedFormula split(const Target& target) const {
    const auto with = [&target](const Rows& rows) { return Target{target.care & rows, target.on & rows}; };
    const auto without = [&target](const Rows& rows) { return Target{target.care - rows, target.on - rows}; };
    const std::span<const Rows> variables = tables_.level(1);
    std::size_t best = 0;
    std::size_t least_work = std::numeric_limits<std::size_t>::max();
    for (std::size_t v = 0; v < variables.size(); ++v) {
      if (are_disjoint(target.care, variables[v]) || is_within(target.care, variables[v])) continue;
      const std::size_t work = least_leaves(with(variables[v])) + least_leaves(without(variables[v]));
      if (work >= least_work) continue;
      best = v;
      least_work = work;
    }
    const SignedFormula where_true = conjunction(approximate(with(variables[best])), formula({best, false}));
    const SignedFormula where_false = conjunction(approximate(without(variables[best])), formula({best, true}));
    return disjunction(where_true, where_false);
  }

  /// A level that takes no more, a tenth of a millisecond, is listed even if the search could do without it.
  static constexpr std::uint64_t k_cheap_work = std::uint64_t{1} << 16;
  /// The cost of a target beside its combinations, in time and memory.
  static constexpr std::size_t k_target_work = 1024;

  MinimalFormulaOptions options_;
  WorkBudget budget_;
  std::vector<std::vector<RowPair>> neighbours_;
  Target target_;
  FormulaTables<Words> tables_;
  bool can_list_ = true;
  /// Targets with a number of leaves that is proved to be too small.
  std::unordered_map<Target, std::size_t, TargetHash> refuted_;
};

template <std::size_t Words>
MinimalFormula solve(const ReducedFunction& function, const MinimalFormulaOptions& options, const RunContext& run) {
  FormulaSearch<Words> search(function, options, run);
  return search.solve();
}

}  // namespace

std::optional<MinimalFormula> minimal_formula(const PartialFunction& function, const MinimalFormulaOptions& options,
                                              const RunContext& run) {
  const ReducedFunction reduced = reduce(function);
  if (std::ranges::count(reduced.values, true) == 0) return MinimalFormula{CsgTree::empty(), true, 0};
  if (std::ranges::count(reduced.values, false) == 0) return MinimalFormula{CsgTree::full(), true, 0};
  const std::size_t words = (reduced.values.size() + 63) / 64;
  if (words <= 1) return solve<1>(reduced, options, run);
  if (words <= 2) return solve<2>(reduced, options, run);
  if (words <= 4) return solve<4>(reduced, options, run);
  if (words <= 8) return solve<8>(reduced, options, run);
  return {};
}

}  // namespace cloud2csg
