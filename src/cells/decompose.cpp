#include "cells/decompose.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <unordered_set>

namespace cloud2csg {
namespace {

using Assignments = std::vector<Assignment>;

Assignment bit_of(std::size_t variable) {
  return Assignment{1} << variable;
}

void sort_unique(Assignments& rows) {
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

Assignments projected(const Assignments& rows, Assignment variables) {
  Assignments result;
  result.reserve(rows.size());
  for (const Assignment row : rows) result.push_back(row & variables);
  sort_unique(result);
  return result;
}

KnownRows projected(const KnownRows& rows, Assignment variables) {
  return {projected(rows.on, variables), projected(rows.off, variables)};
}

bool has(const Assignments& sorted, Assignment row) {
  return std::ranges::binary_search(sorted, row);
}

bool are_disjoint(const Assignments& a, const Assignments& b) {
  return std::ranges::none_of(a, [&b](Assignment row) { return has(b, row); });
}

Assignments united(const Assignments& a, const Assignments& b) {
  Assignments result;
  std::ranges::set_union(a, b, std::back_inserter(result));
  return result;
}

Assignments rows_with(const Assignments& rows, std::size_t variable, bool value) {
  Assignments result;
  std::ranges::copy_if(rows, std::back_inserter(result),
                       [&](Assignment row) { return ((row >> variable & 1U) != 0) == value; });
  return result;
}

KnownRows rows_with(const KnownRows& rows, std::size_t variable, bool value) {
  return {rows_with(rows.on, variable, value), rows_with(rows.off, variable, value)};
}

Assignment variables_of(const KnownRows& rows) {
  Assignment any = 0;
  Assignment all = ~Assignment{0};
  for (const Assignments* some : {&rows.on, &rows.off}) {
    for (const Assignment row : *some) {
      any |= row;
      all &= row;
    }
  }
  return any & ~all;  // a variable that is always true says nothing
}

template <class Visit>
void for_each_variable(Assignment variables, const Visit& visit) {
  for (; variables != 0; variables &= variables - 1) visit(static_cast<std::size_t>(std::countr_zero(variables)));
}

/// Leaves out variables, the last ones first, as long as no two rows of different value become equal.
KnownRows without_needless(KnownRows rows) {
  rows = projected(rows, variables_of(rows));
  const Assignment all = variables_of(rows);
  for (std::size_t variable = k_most_variables; variable-- > 0;) {
    if ((all & bit_of(variable)) == 0) continue;
    KnownRows fewer = projected(rows, ~bit_of(variable));
    if (are_disjoint(fewer.on, fewer.off)) rows = std::move(fewer);
  }
  return rows;
}

bool is_true(const CsgTree& formula, Assignment row) {
  std::vector<bool> values(k_most_variables);
  for_each_variable(row, [&values](std::size_t variable) { values[variable] = true; });
  return contains(formula, values);
}

/// Disjoint sets of variables such that the function is a union of functions of one set each.
class UnionBlocks {
 public:
  explicit UnionBlocks(const KnownRows& rows) : rows_(rows) {
    for_each_variable(variables_of(rows), [this](std::size_t variable) { blocks_.push_back(bit_of(variable)); });
    join_neighbours();
    join_until_covered();
  }

  [[nodiscard]] const Assignments& blocks() const { return blocks_; }

 private:
  /// Joins variables that each alone turn a row off: the part of the union that makes the row true needs them all.
  void join_neighbours() {
    const Assignment variables = variables_of(rows_);
    for (const Assignment row : rows_.on) {
      Assignment flips = 0;
      for_each_variable(variables, [&](std::size_t variable) {
        if (has(rows_.off, row ^ bit_of(variable))) flips |= bit_of(variable);
      });
      join(flips);
    }
  }

  void join(Assignment variables) {
    Assignment joined = variables;
    if (variables == 0) return;
    std::erase_if(blocks_, [&](Assignment block) {
      if ((block & variables) == 0) return false;
      joined |= block;
      return true;
    });
    blocks_.push_back(joined);
  }

  /// Joins blocks until each row that is on differs from all rows that are off within some block.
  void join_until_covered() {
    while (blocks_.size() > 1) {
      std::vector<Assignments> off;
      for (const Assignment block : blocks_) off.push_back(projected(rows_.off, block));
      const auto uncovered = std::ranges::find_if(rows_.on, [&](Assignment row) {
        for (std::size_t b = 0; b < blocks_.size(); ++b) {
          if (!has(off[b], row & blocks_[b])) return false;
        }
        return true;
      });
      if (uncovered == rows_.on.end()) return;
      join(cheapest_cover(*uncovered));
    }
  }

  /// The smallest two blocks that cover the row together, or else all blocks.
  [[nodiscard]] Assignment cheapest_cover(Assignment row) const {
    Assignment best = 0;
    for (std::size_t a = 0; a < blocks_.size(); ++a) {
      for (std::size_t b = a + 1; b < blocks_.size(); ++b) {
        const Assignment both = blocks_[a] | blocks_[b];
        const bool covers =
            std::ranges::none_of(rows_.off, [&](Assignment off) { return (off & both) == (row & both); });
        if (covers && (best == 0 || std::popcount(both) < std::popcount(best))) best = both;
      }
    }
    if (best != 0) return best;
    for (const Assignment block : blocks_) best |= block;
    return best;
  }

  const KnownRows& rows_;
  Assignments blocks_;
};

class Decomposer {
 public:
  Decomposer(const DecompositionOptions& options, const RunContext& run) : budget_(options.budget), run_(run) {}

  CsgTree solve(const KnownRows& given) {
    if (run_.stop.stop_requested()) budget_ = 0;
    const auto variables = static_cast<std::size_t>(std::popcount(variables_of(given)));
    budget_ -= std::min(budget_, (given.on.size() + given.off.size()) * variables);
    if (given.on.empty()) return CsgTree::empty();
    if (given.off.empty()) return CsgTree::full();
    const KnownRows rows = without_needless(given);
    if (std::optional<CsgTree> tree = split_variable(rows)) return *tree;
    if (std::optional<CsgTree> tree = split_blocks(rows)) return *tree;
    return branch(rows);
  }

 private:
  std::optional<CsgTree> split_variable(const KnownRows& rows) {
    std::optional<CsgTree> result;
    for_each_variable(variables_of(rows), [&](std::size_t variable) {
      if (result) return;
      const CsgTree leaf = CsgTree::leaf(static_cast<PrimitiveIndex>(variable));
      const KnownRows with = rows_with(rows, variable, true);
      const KnownRows without = rows_with(rows, variable, false);
      if (with.on.empty()) {
        result = subtract(solve(without), leaf);
      } else if (with.off.empty()) {
        result = unite(solve(without), leaf);
      } else if (without.on.empty()) {
        result = intersect(leaf, solve(with));
      } else if (without.off.empty()) {
        result = unite(complement(leaf), solve(with));
      }
    });
    return result;
  }

  std::optional<CsgTree> split_blocks(const KnownRows& rows) {
    const UnionBlocks of_union(rows);
    const KnownRows negated{.on = rows.off, .off = rows.on};
    const UnionBlocks of_intersection(negated);
    std::optional<CsgTree> best;
    if (of_union.blocks().size() > 1) best = unite_blocks(rows, of_union.blocks());
    if (of_intersection.blocks().size() > 1 && (!best || budget_ > 0)) {
      const CsgTree other = complement(unite_blocks(negated, of_intersection.blocks()));
      if (!best || leaf_count(other) < leaf_count(*best)) best = other;
    }
    return best;
  }

  /// Each block must make true what no later one can and no earlier one did. It may make true what it can.
  CsgTree unite_blocks(const KnownRows& rows, const Assignments& blocks) {
    Assignments open = rows.on;
    std::vector<CsgTree> trees;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      KnownRows part{.on = {}, .off = projected(rows.off, blocks[b])};
      for (const Assignment row : open) {
        const bool can_wait = std::any_of(blocks.begin() + static_cast<std::ptrdiff_t>(b) + 1, blocks.end(),
                                          [&](Assignment block) { return !looks_off(rows, row, block); });
        if (!can_wait) part.on.push_back(row & blocks[b]);
      }
      sort_unique(part.on);
      trees.push_back(solve(part));
      std::erase_if(open, [&](Assignment row) { return is_true(trees.back(), row & blocks[b]); });
    }
    return unite_all(trees);
  }

  static bool looks_off(const KnownRows& rows, Assignment row, Assignment block) {
    return std::ranges::any_of(rows.off, [&](Assignment off) { return (off & block) == (row & block); });
  }

  /// Branches on the variable that gives the smallest formula.
  CsgTree branch(const KnownRows& rows) {
    std::optional<CsgTree> best;
    for_each_variable(variables_of(rows), [&](std::size_t variable) {
      if (best && budget_ == 0) return;
      const CsgTree tree = branch_on(rows, variable);
      if (!best || leaf_count(tree) < leaf_count(*best)) best = tree;
    });
    return *best;
  }

  CsgTree branch_on(const KnownRows& rows, std::size_t variable) {
    const CsgTree leaf = CsgTree::leaf(static_cast<PrimitiveIndex>(variable));
    const KnownRows with = projected(rows_with(rows, variable, true), ~bit_of(variable));
    const KnownRows without = rows_with(rows, variable, false);
    std::optional<CsgTree> best = unite(intersect(leaf, solve(with)), subtract(solve(without), leaf));
    const auto consider = [&](const std::optional<CsgTree>& tree) {
      if (tree && leaf_count(*tree) < leaf_count(*best)) best = tree;
    };
    if (budget_ == 0) return *best;
    const auto inside = [&leaf](const CsgTree& part) { return intersect(leaf, part); };
    const auto outside = [&leaf](const CsgTree& part) { return subtract(part, leaf); };
    consider(add_to_common(without, with, inside));
    consider(take_from_common(without, with, inside));
    consider(add_to_common(with, without, outside));
    consider(take_from_common(with, without, outside));
    return *best;
  }

  /// base | part: the base holds for both values of the variable, the part is on for one of them alone.
  template <class Restrict>
  std::optional<CsgTree> add_to_common(const KnownRows& always, const KnownRows& sometimes, const Restrict& restrict) {
    if (!are_disjoint(always.on, sometimes.off)) return std::nullopt;
    const CsgTree base = solve({.on = always.on, .off = united(always.off, sometimes.off)});
    KnownRows rest = sometimes;
    std::erase_if(rest.on, [&](Assignment row) { return is_true(base, row); });
    return unite(base, restrict(solve(rest)));
  }

  /// base - part
  template <class Restrict>
  std::optional<CsgTree> take_from_common(const KnownRows& always, const KnownRows& sometimes,
                                          const Restrict& restrict) {
    if (!are_disjoint(always.off, sometimes.on)) return std::nullopt;
    const CsgTree base = solve({.on = united(always.on, sometimes.on), .off = always.off});
    KnownRows taken{.on = sometimes.off, .off = sometimes.on};
    std::erase_if(taken.on, [&](Assignment row) { return !is_true(base, row); });
    return subtract(base, restrict(solve(taken)));
  }

  std::size_t budget_;
  const RunContext& run_;
};

}  // namespace

CsgTree decompose(const KnownRows& rows, const DecompositionOptions& options, const RunContext& run) {
  KnownRows sorted = rows;
  sort_unique(sorted.on);
  sort_unique(sorted.off);
  return Decomposer(options, run).solve(sorted);
}

Assignment essential_variables(const KnownRows& rows) {
  const std::unordered_set<Assignment> off(rows.off.begin(), rows.off.end());
  Assignment essential = 0;
  for (const Assignment row : rows.on) {
    for (std::size_t variable = 0; variable < k_most_variables; ++variable) {
      if (off.contains(row ^ bit_of(variable))) essential |= bit_of(variable);
    }
  }
  return essential;
}

}  // namespace cloud2csg
