#pragma once

#include <vector>

#include "bench/experiment/figure.hpp"
#include "bench/experiment/scaling.hpp"

namespace cloud2csg {

/// Log-log figures: time and memory by size, with a line per family; steps by primitives, with a figure per family.
[[nodiscard]] std::vector<Figure> scaling_figures(const ScalingResults& results);

}  // namespace cloud2csg
