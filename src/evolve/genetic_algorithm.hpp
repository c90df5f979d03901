#pragma once

#include <span>

#include "cloud2csg/evolve.hpp"

namespace cloud2csg {

/// The genetic algorithm of the paper on one table; `seeds` join the first generation.
[[nodiscard]] Evolution run_genetic_algorithm(const RankClasses& table, std::span<const CsgTree> seeds,
                                              const GaOptions& options, std::uint64_t item, const RunContext& run);

}  // namespace cloud2csg
