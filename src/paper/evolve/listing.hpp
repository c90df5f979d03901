#pragma once

#include <stop_token>

#include "paper/evolve/genetic_algorithm.hpp"

namespace cloud2csg {

struct Listing {
  ScoredTree best;
  std::size_t evaluations = 0;
  bool complete = true;
};

/// The best of all trees that use each primitive of the table at most once, and their complements. The smallest stands
/// for all that select the same in every class. The paper lists for 1 and 2 primitives; 1, 4, 32, 416 and 7552 trees
/// (and complements) use all of 1, 2, 3, 4 and 5. Precondition: few primitives. When stopped, only some subsets are
/// listed.
[[nodiscard]] Listing list_trees(const RankClasses& table, const std::stop_token& stop = {});

}  // namespace cloud2csg
