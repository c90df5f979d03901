#pragma once

#include "cloud2csg/advanced/evolve.hpp"
#include "paper/evolve/scored_tree.hpp"

namespace cloud2csg {

/// local_search() on any objective; the limit of work is in the objective's terms.
[[nodiscard]] Evolution local_search(const TreeObjective& objective, const CsgTree& start,
                                     const LocalSearchOptions& options, const RunContext& run);

}  // namespace cloud2csg
