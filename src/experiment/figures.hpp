#pragma once

#include <string>
#include <vector>

#include "cloud2csg/experiment.hpp"

namespace cloud2csg {

/// A script for gnuplot, data included, that prints an .svg.
struct Figure {
  std::string name;  ///< of its file, without the ending
  std::string script;
};

/// Durations at low and high sampling by mode, sizes of trees, share of the steps.
[[nodiscard]] std::vector<Figure> paper_figures(const PaperResults& results);

}  // namespace cloud2csg
