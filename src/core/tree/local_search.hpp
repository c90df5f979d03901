#pragma once

#include "cloud2csg/advanced/local_search.hpp"
#include "cloud2csg/run_context.hpp"
#include "core/tree/tree_objective.hpp"

namespace cloud2csg {

struct LocalOptimum : ScoredTree {
  std::size_t evaluations = 0;
  bool complete = true;  ///< false when it was stopped early: the best tree so far
};

/// Climbs from `start` by the best of all small changes (a node replaced by its child, by a leaf, by another operation;
/// a leaf put in anywhere) until none improves the score. The limit of work is in the objective's terms. Deterministic.
[[nodiscard]] LocalOptimum local_search(const TreeObjective& objective, const CsgTree& start,
                                        const LocalSearchOptions& options, const RunContext& run);

}  // namespace cloud2csg
