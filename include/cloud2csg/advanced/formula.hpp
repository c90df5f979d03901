#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

/// Small formulas for what is known of a solid: which combinations of primitives are in it, which are not.
namespace cloud2csg {

/// A Boolean function that is known for some assignments of its variables only. A variable is a primitive, an
/// assignment says which primitives a place is inside of, and the value whether the place is in the solid. What is not
/// known may become anything.
class PartialFunction {
 public:
  explicit PartialFunction(std::size_t variables) : columns_(variables) {}

  /// Adds a row: the assignment in which `true_variables` are true and all others false. Precondition: the same
  /// assignment was not added with the other value.
  void add(std::span<const PrimitiveIndex> true_variables, bool value);

  [[nodiscard]] std::size_t variables() const { return columns_.size(); }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Of a column of bits, one a row: bit r % 64 of word r / 64. Those past the last row are zero.
  [[nodiscard]] std::size_t words() const { return (rows_ + 63) / 64; }
  [[nodiscard]] std::span<const std::uint64_t> column(PrimitiveIndex variable) const { return columns_[variable]; }
  [[nodiscard]] std::span<const std::uint64_t> values() const { return values_; }

  [[nodiscard]] bool is_true(std::size_t row, PrimitiveIndex variable) const {
    return (columns_[variable][row / 64] >> (row % 64) & 1U) != 0;
  }
  [[nodiscard]] bool value(std::size_t row) const { return (values_[row / 64] >> (row % 64) & 1U) != 0; }

 private:
  std::size_t rows_ = 0;
  std::vector<std::vector<std::uint64_t>> columns_;  ///< by variable
  std::vector<std::uint64_t> values_;
};

/// The value of a formula over the variables in each row, as a column of bits. O(size x words)
[[nodiscard]] std::vector<std::uint64_t> evaluate(const CsgTree& formula, const PartialFunction& function);
/// Whether the formula has the function's value in every row. O(size x words)
[[nodiscard]] bool agrees(const CsgTree& formula, const PartialFunction& function);

/// How much work to do at most: counted, never timed, so that the same function gives the same formula everywhere.
/// Its fields: see the table.
struct MinimalFormulaOptions {
  std::size_t table_limit = std::size_t{1} << 20;
  std::uint64_t combination_limit = 2'000'000'000;
};
void option_table(OptionsOf<MinimalFormulaOptions>, auto&& field) {
  using O = MinimalFormulaOptions;
  field(&O::table_limit, "table_limit",
        "Functions of few leaves that are listed, some 30 bytes each and 8 more a word. All of up to five leaves over "
        "eight variables are below 2^20.");
  field(&O::combination_limit, "combination_limit",
        "Pairs of such functions that are tried, times the words. 2e9 take two or three seconds.");
}

struct MinimalFormula {
  CsgTree tree;                  ///< over the function's variables, as simplify() leaves it
  bool is_minimal = false;       ///< whether it is proved that no formula of fewer leaves agrees with the function
  std::size_t least_leaves = 0;  ///< no formula of fewer leaves agrees: this is proved in any case
};

/// A smallest formula of unions, intersections and differences, and maybe a complement at the root, that agrees with
/// the function; leaves count as often as they appear. When the work or the run ends before one is found, or proved to
/// be, a small one that need not be smallest; it agrees all the same. None only for a function of more than 512
/// different assignments, once variables that are equal (or complements) in all rows count as one.
///
/// A formula over all of space, with the complement, is as good as any other: who wants a bounded solid adds the row
/// without true variables. Of several smallest formulas always the same is taken.
///
/// The work is exponential in the leaves, not in the variables or rows: mostly well below a second for ten leaves over
/// eight variables. Memory is in proportion to the limit of tables.
[[nodiscard]] std::optional<MinimalFormula> minimal_formula(const PartialFunction& function,
                                                            const MinimalFormulaOptions& options = {},
                                                            const RunContext& run = {});

}  // namespace cloud2csg
