#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cells/row_set.hpp"
#include "cells/signed_formula.hpp"
#include "cells/work_budget.hpp"

namespace cloud2csg {

/// All functions of few leaves, by the least number of leaves. A function and its complement count as one, since a
/// complement costs no leaf: what is kept is the one that is false in the first row. Constants are left out.
template <std::size_t Words>
class FormulaTables {
 public:
  using Rows = RowSet<Words>;

  explicit FormulaTables(const Rows& all) : all_(all), slots_(k_least_slots, k_no_table) {}

  /// Adds a function of one leaf. Precondition: not constant, no variable before it the same or its complement, no
  /// level was added.
  void add_variable(PrimitiveIndex variable, const Rows& rows) {
    insert(rows, {.first = variable});
    ends_ = {0, tables_.size()};
  }

  /// The most leaves of the functions that are kept.
  [[nodiscard]] std::size_t levels() const { return ends_.size() - 1; }
  [[nodiscard]] std::size_t size() const { return tables_.size(); }
  /// The functions of so many leaves, not of fewer. Precondition: 1 <= leaves <= levels().
  [[nodiscard]] std::span<const Rows> level(std::size_t leaves) const {
    return std::span(tables_).subspan(level_begin(leaves), ends_[leaves] - ends_[leaves - 1]);
  }
  /// The index of the first of them among all.
  [[nodiscard]] std::size_t level_begin(std::size_t leaves) const { return ends_[leaves - 1]; }

  /// How many conjunctions the next level is made of, times the words of each.
  [[nodiscard]] std::uint64_t next_level_work() const {
    std::uint64_t pairs = 0;
    for (std::size_t less = 1; less <= (levels() + 1) / 2; ++less) {
      pairs += std::uint64_t{level(less).size()} * level(levels() + 1 - less).size();
    }
    return 4 * Words * pairs;
  }

  /// Adds the functions that need one leaf more. False, and nothing is added, when the limit or the budget is too small
  /// for all of them: no level can be added then. O(next_level_work())
  bool add_level(std::size_t table_limit, WorkBudget& budget) {
    const std::size_t leaves = levels() + 1;
    for (std::size_t less = 1; less <= leaves / 2; ++less) {
      for (std::size_t a = level_begin(leaves - less); a < ends_[leaves - less]; ++a) {
        // Of a level with itself, each pair once.
        const std::size_t end = 2 * less == leaves ? a : ends_[less];
        if (tables_.size() > table_limit || !budget.spend(4 * Words * (end - std::min(end, level_begin(less))))) {
          tables_.resize(ends_.back());
          return false;
        }
        for (std::size_t b = level_begin(less); b < end; ++b) insert_conjunctions(a, b);
      }
    }
    ends_.push_back(tables_.size());
    return true;
  }

  /// A formula of the function that is kept under the index: the leaves are as many as its level says.
  [[nodiscard]] SignedFormula formula(std::size_t index) const {
    const Origin& origin = origins_[index];
    if (index < ends_[1]) return {CsgTree::leaf(origin.first), origin.is_complemented};
    return conjunction(formula(origin.first).negated_if(origin.is_first_negated),
                       formula(origin.second).negated_if(origin.is_second_negated))
        .negated_if(origin.is_complemented);
  }

 private:
  static constexpr std::size_t k_least_slots = 1024;
  static constexpr std::uint32_t k_no_table = ~std::uint32_t{0};

  /// The conjunction a function is, or is the complement of.
  struct Origin {
    std::uint32_t first = 0;  ///< an index; of the functions of one leaf, the variable
    std::uint32_t second = 0;
    bool is_first_negated = false;
    bool is_second_negated = false;
    bool is_complemented = false;
  };

  void insert_conjunctions(std::size_t a, std::size_t b) {
    const Rows first = tables_[a];
    const Rows second = tables_[b];
    Origin origin{.first = static_cast<std::uint32_t>(a), .second = static_cast<std::uint32_t>(b)};
    insert(first & second, origin);
    origin.is_second_negated = true;
    insert(first - second, origin);
    origin.is_first_negated = true;
    insert(all_ - (first | second), origin);
    origin.is_second_negated = false;
    insert(second - first, origin);
  }

  void insert(Rows rows, Origin origin) {
    if (rows.contains(0)) {
      rows = all_ - rows;
      origin.is_complemented = true;
    }
    if (rows.is_empty()) return;
    const std::size_t slot = find_slot(rows);
    if (slots_[slot] != k_no_table) return;
    slots_[slot] = static_cast<std::uint32_t>(tables_.size());
    tables_.push_back(rows);
    origins_.resize(tables_.size());
    origins_.back() = origin;
    if (2 * tables_.size() > slots_.size()) grow();
  }

  /// Where the function is, or belongs.
  [[nodiscard]] std::size_t find_slot(const Rows& rows) const {
    std::size_t slot = rows.hash() >> 20 & (slots_.size() - 1);
    while (slots_[slot] != k_no_table && !(tables_[slots_[slot]] == rows)) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  void grow() {
    slots_.assign(4 * slots_.size(), k_no_table);
    for (std::uint32_t i = 0; i < tables_.size(); ++i) slots_[find_slot(tables_[i])] = i;
  }

  Rows all_;
  std::vector<Rows> tables_;  ///< level by level
  std::vector<Origin> origins_;
  std::vector<std::size_t> ends_{0};  ///< of each level in the tables; first that of no leaves
  std::vector<std::uint32_t> slots_;  ///< a hash table of indices
};

}  // namespace cloud2csg
