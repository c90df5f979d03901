#pragma once

#include <string>

#include "bench/experiment/paper.hpp"

namespace cloud2csg {

/// paper.md: setting, tables, and figures if there are pictures. Precondition: there is a run.
[[nodiscard]] std::string paper_markdown(const PaperResults& results, bool has_pictures);

}  // namespace cloud2csg
