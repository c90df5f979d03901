#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

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

}  // namespace cloud2csg
