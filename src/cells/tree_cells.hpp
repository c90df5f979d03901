#pragma once

#include <vector>

#include "cloud2csg/advanced/cells.hpp"
#include "cloud2csg/advanced/restrict.hpp"

namespace cloud2csg {

/// Which cells are in a tree. O(size of all cells x log of the tree's size)
[[nodiscard]] inline std::vector<bool> cells_in(const CsgTree& tree, const CellComplex& complex) {
  const TreeRestriction restriction(tree);
  const std::vector<bool> everywhere(complex.points_of_primitive.size(), true);
  std::vector<bool> result;
  result.reserve(complex.cells.size());
  for (const Cell& cell : complex.cells) result.push_back(contains(restriction.restrict_to(cell), everywhere));
  return result;
}

}  // namespace cloud2csg
