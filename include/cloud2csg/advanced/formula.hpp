#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

/// Small formulas for a partly known solid: some combinations of primitives are in it, some are out.
namespace cloud2csg {

/// A Boolean function that is known for some assignments only. A variable is a primitive, an assignment tells which
/// primitives contain a place, and the value tells whether the place is in the solid. Unknown values are free.
class PartialFunction {
 public:
  explicit PartialFunction(std::size_t variables) : columns_(variables) {}

  /// Adds an assignment in which exactly `true_variables` are true. Precondition: no contradiction to earlier rows.
  void add(std::span<const PrimitiveIndex> true_variables, bool value);

  [[nodiscard]] std::size_t variables() const { return columns_.size(); }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Words in a column of bits. Row r is bit r % 64 of word r / 64; bits past the last row are zero.
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

/// The formula's value in each row, as a column of bits. O(size x words)
[[nodiscard]] std::vector<std::uint64_t> evaluate(const CsgTree& formula, const PartialFunction& function);
/// Whether the formula has the function's value in every row. O(size x words)
[[nodiscard]] bool agrees(const CsgTree& formula, const PartialFunction& function);

/// Limits on the work. They are counts, not times, so that a function gives the same formula on every machine.
struct MinimalFormulaOptions {
  std::size_t table_limit = std::size_t{1} << 20;
  std::uint64_t combination_limit = 2'000'000'000;
};
void option_table(OptionsOf<MinimalFormulaOptions>, auto&& field) {
  using O = MinimalFormulaOptions;
  field(&O::table_limit, "table_limit",
        "Largest number of listed functions with few leaves, of about 30 bytes each plus 8 per word. All functions of "
        "up to five leaves over eight variables are fewer than 2^20.");
  field(&O::combination_limit, "combination_limit",
        "Largest number of pairs of listed functions to try, times the words. 2e9 take two or three seconds.");
}

struct MinimalFormula {
  CsgTree tree;                  ///< over the function's variables, in the form of simplify()
  bool is_minimal = false;       ///< it is proved that no formula of fewer leaves agrees with the function
  std::size_t least_leaves = 0;  ///< proved lower bound on the leaves of any formula that agrees
};

/// A formula with the fewest leaves that agrees with the function, from unions, intersections, differences and at most
/// one complement at the root. Repeated leaves count. When the work or the run ends before a smallest formula is found
/// and proved, it returns a small one that agrees. Returns nothing only for more than 512 different assignments, after
/// merging variables that are equal (or complements) in all rows.
///
/// The formula may be unbounded unless the row without true variables is false. The choice is deterministic.
///
/// The work is exponential in the leaves, not in the variables or rows: mostly well below a second for ten leaves over
/// eight variables. Memory is proportional to `table_limit`.
[[nodiscard]] std::optional<MinimalFormula> minimal_formula(const PartialFunction& function,
                                                            const MinimalFormulaOptions& options = {},
                                                            const RunContext& run = {});

}  // namespace cloud2csg
