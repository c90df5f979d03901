#pragma once

#include <span>

#include "cloud2csg/advanced/evolve.hpp"
#include "paper/evolve/scored_tree.hpp"

namespace cloud2csg {

/// The genetic algorithm of the paper on one table; `seeds` join the first generation.
[[nodiscard]] Evolution run_genetic_algorithm(const RankClasses& table, std::span<const CsgTree> seeds,
                                              const GaOptions& options, std::uint64_t item, const RunContext& run);

/// The same on any objective.
[[nodiscard]] Evolution run_genetic_algorithm(const TreeObjective& objective, std::span<const CsgTree> seeds,
                                              const GaOptions& options, std::uint64_t item, const RunContext& run);

}  // namespace cloud2csg
