#pragma once

#include "cloud2csg/run_context.hpp"
#include "raw/solids/decision_list.hpp"

namespace cloud2csg {

/// A decision list of low cost: rules are put in where they gain most, one by one or two that only gain together, from
/// several starts; then each is taken out, or exchanged for what gains more, as long as the cost falls. Deterministic.
/// Stopped early, the best list so far.
[[nodiscard]] DecisionList search_list(const TermSpace& space, const TermCosts& costs, std::size_t most_rules,
                                       const RunContext& run = {});

}  // namespace cloud2csg
