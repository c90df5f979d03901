#pragma once

#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "core/base/random.hpp"

/// Formulas that are known, to be found again.
namespace cloud2csg::test {

/// With these leaves, in this order but for differences. Precondition: there is one.
inline CsgTree random_formula(std::span<const PrimitiveIndex> leaves, RandomStream& random) {
  if (leaves.size() == 1) return CsgTree::leaf(leaves.front());
  const std::size_t cut = 1 + random.below(leaves.size() - 1);
  const CsgTree a = random_formula(leaves.first(cut), random);
  const CsgTree b = random_formula(leaves.subspan(cut), random);
  switch (random.below(4)) {
    case 0:
      return unite(a, b);
    case 1:
      return intersect(a, b);
    case 2:
      return subtract(a, b);
    default:
      return subtract(b, a);
  }
}

/// Each variable once.
inline CsgTree random_read_once_formula(std::size_t variables, RandomStream& random) {
  std::vector<PrimitiveIndex> leaves(variables);
  std::iota(leaves.begin(), leaves.end(), 0U);
  for (std::size_t i = leaves.size(); i > 1; --i) std::swap(leaves[i - 1], leaves[random.below(i)]);
  return random_formula(leaves, random);
}

}  // namespace cloud2csg::test
