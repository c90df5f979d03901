#pragma once

#include <cstddef>

namespace cloud2csg {

/// Of searches that climb by the best of all small changes of a tree.
struct LocalSearchOptions {
  /// Only moves that make the tree smaller: redundancy removal.
  bool shrink_only = false;
  std::size_t evaluation_limit = 100'000;
  /// Evaluations x classes x nodes: some ten seconds at most, however large the table is. On the cells of CellComplex:
  /// evaluations x (cells + patches + nodes x cells / 64).
  double work_limit = 4e10;
};

}  // namespace cloud2csg
