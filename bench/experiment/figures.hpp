#pragma once

#include <vector>

#include "bench/experiment/figure.hpp"
#include "bench/experiment/paper.hpp"

namespace cloud2csg {

/// Durations at low and high sampling by mode, tree sizes, share of the steps.
[[nodiscard]] std::vector<Figure> paper_figures(const PaperResults& results);

}  // namespace cloud2csg
