#pragma once

#include <vector>

#include "cloud2csg/extract.hpp"

namespace cloud2csg::test {

/// A trust in cells that no points ever earn: `automatic` goes straight to the search.
inline constexpr double k_never_by_cells = 2;

/// Options of every strategy; `automatic` as it is, and without cells.
inline std::vector<ExtractOptions> all_strategies() {
  return {{.strategy = Strategy::automatic},
          {.strategy = Strategy::automatic, .cell_trust = k_never_by_cells},
          {.strategy = Strategy::cells},
          {.strategy = Strategy::partition},
          {.strategy = Strategy::baseline}};
}

/// Each strategy that may go by partitions, made to.
inline std::vector<ExtractOptions> all_searches() {
  return {{.strategy = Strategy::automatic, .cell_trust = k_never_by_cells},
          {.strategy = Strategy::partition},
          {.strategy = Strategy::baseline}};
}

/// What is tried when nothing else is said, and what is done where that does not hold.
inline std::vector<ExtractOptions> with_and_without_cells() {
  return {ExtractOptions{}, {.cell_trust = k_never_by_cells}};
}

}  // namespace cloud2csg::test
