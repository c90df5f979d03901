#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "core/tree/interner.hpp"

/// The n-ary form that simplify() works on: a conjunction of literals and of negated conjunctions of the same kind. It
/// expresses unions, intersections, differences and complements: a & b = [a b], a - b = [a ~b], a | b = [~[~a ~b]]. So
/// each rule of set algebra and its dual are one rule here.
///
/// A formula is a flat sequence of tokens: `k_open`, the conjunction's members, `k_close`. The outermost conjunction is
/// the formula itself; every inner one counts as negated. [] is all of space, [[]] is empty.
namespace cloud2csg {

/// Narrows an index or a count that is known to fit.
[[nodiscard]] constexpr std::uint32_t narrow(std::size_t n) {
  return static_cast<std::uint32_t>(n);
}

using Token = std::uint32_t;
constexpr Token k_open = 0xffffffffU;
constexpr Token k_close = 0xfffffffeU;

/// 2 * primitive, plus 1 for its complement. Primitives are numbered densely within a formula.
using Literal = Token;
[[nodiscard]] constexpr Literal negated(Literal literal) {
  return literal ^ 1U;
}
[[nodiscard]] constexpr bool is_negative(Literal literal) {
  return (literal & 1U) != 0;
}
[[nodiscard]] constexpr std::uint32_t variable(Literal literal) {
  return literal >> 1U;
}

struct Formula {
  std::vector<Token> tokens;
  std::vector<PrimitiveIndex> primitives;  ///< by dense number, ascending
};

/// O(size log size).
[[nodiscard]] Formula to_formula(const CsgTree& tree);
/// The smallest tree with the same literals in the same order: 2 * literals - 1 nodes, and a complement at the root
/// when the solid is unbounded, that is, holds the points outside of all primitives. O(size). Precondition: every inner
/// conjunction holds two members or more, or the formula is [[]].
[[nodiscard]] CsgTree to_tree(const Formula& formula);

/// Where conjunctions end and which are equal up to order. Each member has a **code**: a literal is its own code, and
/// the code of an inner conjunction follows from its class.
class FormulaIndex {
 public:
  /// Indexes a formula, reusing the memory. O(size log size).
  void build(const Formula& formula);

  /// The token after a literal, or after the closing token of the conjunction that opens at `member`.
  [[nodiscard]] std::uint32_t next(std::uint32_t member) const { return next_[member]; }
  [[nodiscard]] std::uint32_t code(std::uint32_t member) const { return code_[member]; }
  [[nodiscard]] std::uint32_t class_of(std::uint32_t open) const { return code_[open] - first_class_code_; }
  /// Codes are below this.
  [[nodiscard]] std::size_t code_count() const { return first_class_code_ + classes_.size(); }
  /// The codes of the members of a class of conjunctions, ascending, each once.
  [[nodiscard]] std::span<const std::uint32_t> members(std::uint32_t class_of_node) const {
    return classes_.key(class_of_node);
  }
  /// How many literals a member holds.
  [[nodiscard]] std::uint32_t literals(std::uint32_t member_code) const {
    return member_code < first_class_code_ ? 1 : literals_[member_code - first_class_code_];
  }

 private:
  void close(std::uint32_t at);

  std::uint32_t first_class_code_ = 0;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> code_;
  Interner classes_;
  std::vector<std::uint32_t> literals_;  ///< by class
  struct Open {
    std::uint32_t token;
    std::size_t first_code;
  };
  std::vector<Open> open_;
  std::vector<std::uint32_t> codes_;
};

}  // namespace cloud2csg
