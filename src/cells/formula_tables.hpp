#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// A set of rows of a function. A formula is known by the rows where it is true.
template <std::size_t Words>
struct RowSet {
  std::array<std::uint64_t, Words> words{};

  void insert(std::size_t row) { words[row / 64] |= std::uint64_t{1} << (row % 64); }
  [[nodiscard]] bool contains(std::size_t row) const { return (words[row / 64] >> (row % 64) & 1U) != 0; }

  [[nodiscard]] bool is_empty() const {
    std::uint64_t any = 0;
    for (const std::uint64_t word : words) any |= word;
    return any == 0;
  }

  [[nodiscard]] std::size_t size() const {
    std::size_t count = 0;
    for (const std::uint64_t word : words) count += static_cast<std::size_t>(std::popcount(word));
    return count;
  }

  [[nodiscard]] std::uint64_t hash() const {
    std::uint64_t hash = 0;
    for (const std::uint64_t word : words) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 32;
    }
    return hash * 0xd6e8feb86659fd93ULL;
  }

  friend RowSet operator&(RowSet a, const RowSet& b) {
    for (std::size_t w = 0; w < Words; ++w) a.words[w] &= b.words[w];
    return a;
  }
  friend RowSet operator|(RowSet a, const RowSet& b) {
    for (std::size_t w = 0; w < Words; ++w) a.words[w] |= b.words[w];
    return a;
  }
  friend RowSet operator-(RowSet a, const RowSet& b) {
    for (std::size_t w = 0; w < Words; ++w) a.words[w] &= ~b.words[w];
    return a;
  }
  friend bool operator==(const RowSet&, const RowSet&) = default;
};

template <std::size_t Words>
[[nodiscard]] bool are_disjoint(const RowSet<Words>& a, const RowSet<Words>& b) {
  return (a & b).is_empty();
}
template <std::size_t Words>
[[nodiscard]] bool is_within(const RowSet<Words>& inner, const RowSet<Words>& outer) {
  return (inner - outer).is_empty();
}

/// A formula without complements, or the complement of one: De Morgan's rules turn every formula into that.
struct SignedFormula {
  CsgTree tree;
  bool is_complemented = false;

  [[nodiscard]] SignedFormula negated_if(bool negate) && { return {std::move(tree), is_complemented != negate}; }
};

[[nodiscard]] inline SignedFormula conjunction(const SignedFormula& a, const SignedFormula& b) {
  if (a.is_complemented && b.is_complemented) return {unite(a.tree, b.tree), true};
  if (a.is_complemented) return {subtract(b.tree, a.tree)};
  if (b.is_complemented) return {subtract(a.tree, b.tree)};
  return {intersect(a.tree, b.tree)};
}

[[nodiscard]] inline SignedFormula disjunction(SignedFormula a, SignedFormula b) {
  return conjunction(std::move(a).negated_if(true), std::move(b).negated_if(true)).negated_if(true);
}

/// The work that is left. It is counted, so that a result does not depend on the machine, except after a stop.
class WorkBudget {
 public:
  WorkBudget(std::uint64_t limit, std::stop_token stop) : left_(limit), stop_(std::move(stop)) {}

  /// Spends some of the budget. False once there is not enough, and from then on.
  [[nodiscard]] bool spend(std::uint64_t work) {
    if (work > left_ || stop_.stop_requested()) is_exhausted_ = true;
    if (!is_exhausted_) left_ -= work;
    return !is_exhausted_;
  }
  [[nodiscard]] std::uint64_t left() const { return left_; }
  [[nodiscard]] bool is_exhausted() const { return is_exhausted_; }

 private:
  std::uint64_t left_;
  std::stop_token stop_;
  bool is_exhausted_ = false;
};

/// All functions of few leaves, by the least number of leaves. Keeps one of a function and its complement, which costs
/// no leaf: the one that is false in the first row. Leaves out constants.
template <std::size_t Words>
class FormulaTables {
 public:
  using Rows = RowSet<Words>;

  explicit FormulaTables(const Rows& all) : all_(all), slots_(k_least_slots, k_no_table) {}

  /// Adds a function of one leaf. Precondition: no level was added; not constant, nor equal or complementary to others.
  void add_variable(PrimitiveIndex variable, const Rows& rows) {
    insert(rows, {.first = variable});
    ends_ = {0, tables_.size()};
  }

  /// The most leaves of listed functions.
  [[nodiscard]] std::size_t levels() const { return ends_.size() - 1; }
  [[nodiscard]] std::size_t size() const { return tables_.size(); }
  /// The functions that need exactly `leaves` leaves. Precondition: 1 <= leaves <= levels().
  [[nodiscard]] std::span<const Rows> level(std::size_t leaves) const {
    return std::span(tables_).subspan(level_begin(leaves), ends_[leaves] - ends_[leaves - 1]);
  }
  /// The index of the level's first function among all.
  [[nodiscard]] std::size_t level_begin(std::size_t leaves) const { return ends_[leaves - 1]; }

  /// The number of conjunctions for the next level, times the words of each.
  [[nodiscard]] std::uint64_t next_level_work() const {
    std::uint64_t pairs = 0;
    for (std::size_t less = 1; less <= (levels() + 1) / 2; ++less) {
      pairs += std::uint64_t{level(less).size()} * level(levels() + 1 - less).size();
    }
    return 4 * Words * pairs;
  }

  /// Adds the functions that need one leaf more. Returns false and adds nothing when the limit or the budget is too
  /// small for all of them. No level can be added then. O(next_level_work())
  bool add_level(std::size_t table_limit, WorkBudget& budget) {
    const std::size_t leaves = levels() + 1;
    for (std::size_t less = 1; less <= leaves / 2; ++less) {
      for (std::size_t a = level_begin(leaves - less); a < ends_[leaves - less]; ++a) {
        // A level with itself: each pair once.
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

  /// A formula of the function at `index`, with as many leaves as its level says.
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

  /// The conjunction that a function, or its complement, is.
  struct Origin {
    std::uint32_t first = 0;  ///< an index; for functions of one leaf, the variable
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
  std::vector<std::size_t> ends_{0};  ///< ends of the levels in the tables; the first is that of no leaves
  std::vector<std::uint32_t> slots_;  ///< a hash table of indices
};

}  // namespace cloud2csg
