#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "bench/experiment/paper.hpp"
#include "bench/experiment/step.hpp"
#include "bench/experiment/table.hpp"

namespace cloud2csg {

using Measure = std::function<double(const PaperRun&)>;

[[nodiscard]] Spread measure(const PaperResults& results, std::string_view model, Sampling sampling,
                             std::string_view mode, const Measure& value);

[[nodiscard]] double milliseconds(const PaperRun& run);
/// Percentage of the extraction's time.
[[nodiscard]] Measure share_of(const Step& step);

/// All tables of the report. Trees and their quality do not depend on parallelism, so they come from BST and SST.
[[nodiscard]] std::vector<Table> paper_tables(const PaperResults& results);

/// One row per run.
[[nodiscard]] Table runs_table(const PaperResults& results);

}  // namespace cloud2csg
