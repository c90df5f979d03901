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

/// A measure over the repeats of one model, sampling and mode.
[[nodiscard]] Spread measure(const PaperResults& results, std::string_view model, Sampling sampling,
                             std::string_view mode, const Measure& value);

[[nodiscard]] double milliseconds(const PaperRun& run);
/// Of the extraction's time, in percent.
[[nodiscard]] Measure share_of(const Step& step);

/// All tables of the report. Trees and their quality do not depend on how a mode runs in parallel: they are those of
/// BST and SST.
[[nodiscard]] std::vector<Table> paper_tables(const PaperResults& results);

/// A row a run.
[[nodiscard]] Table runs_table(const PaperResults& results);

}  // namespace cloud2csg
