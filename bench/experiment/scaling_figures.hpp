#pragma once

#include <vector>

#include "bench/experiment/figure.hpp"
#include "bench/experiment/scaling.hpp"

namespace cloud2csg {

/// Time and memory by size, a line a family; steps by primitives, a figure a family. All log-log.
[[nodiscard]] std::vector<Figure> scaling_figures(const ScalingResults& results);

}  // namespace cloud2csg
