#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/experiment/scaling.hpp"
#include "bench/experiment/table.hpp"

namespace cloud2csg {

struct Quantity {
  std::string name;
  std::function<double(const ScalingRun&)> value;
};

/// Milliseconds of each step and of the whole extraction.
[[nodiscard]] std::vector<Quantity> durations();
[[nodiscard]] Quantity extraction_milliseconds();
/// In megabytes, without the cloud.
[[nodiscard]] Quantity peak_memory();

/// Over the repeats of a case that the time limit did not cut off.
[[nodiscard]] Spread measure(const ScalingResults& results, const ScalingCase& scaling_case, const Quantity& quantity);

/// The fitted growth of a quantity along a sweep, from all repeats.
[[nodiscard]] PowerLaw fitted(const ScalingResults& results, Sweep sweep, Family family, const Quantity& quantity);

/// "primitives, 500 points each"...
[[nodiscard]] std::string description(const ScalingOptions& options, Sweep sweep);

[[nodiscard]] std::vector<Table> scaling_tables(const ScalingResults& results);

/// One row per run.
[[nodiscard]] Table scaling_runs_table(const ScalingResults& results);

}  // namespace cloud2csg
