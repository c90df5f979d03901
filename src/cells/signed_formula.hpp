#pragma once

#include <utility>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// A formula without complements, or the complement of one: what all formulas of unions, intersections, differences and
/// complements can be turned into, leaf by leaf, by the rules of De Morgan.
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

}  // namespace cloud2csg
