#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/experiment/report_files.hpp"
#include "bench/experiment/scaling.hpp"
#include "bench/experiment/scaling_figures.hpp"
#include "bench/experiment/scaling_tables.hpp"

namespace cloud2csg {
namespace {

std::string setting(const ScalingResults& results) {
  const ScalingOptions& options = results.options;
  const auto [first, last] =
      std::minmax_element(results.runs.begin(), results.runs.end(),
                          [](const ScalingRun& a, const ScalingRun& b) { return a.finished < b.finished; });
  return fmt::format(
      "{}; runs from {} to {}.\n"
      "Noise {}, {} repeats with seeds {} to {} for model, cloud and search; {} threads.\n"
      "Mean ± standard deviation over the repeats.\n",
      describe(results.environment), first->finished, last->finished, options.noise, options.repeats, options.seed,
      options.seed + options.repeats - 1, options.threads);
}

std::string thread_check(const ScalingResults& results) {
  const std::vector<std::string> disagreements = thread_disagreements(results);
  if (!disagreements.empty()) {
    return fmt::format("**Trees differ by the number of threads**, which must not be:\n- {}\n",
                       fmt::join(disagreements, "\n- "));
  }
  return results.options.threads == 1 ? "" : "The number of threads changed no tree.\n";
}

/// Runs cut off by the time limit appear only in the list of runs.
std::string cut_off(const ScalingResults& results) {
  const auto count =
      std::count_if(results.runs.begin(), results.runs.end(), [](const auto& run) { return !run.complete; });
  if (count == 0) return "";
  return fmt::format("{} of {} runs were ended by the time limit of {} s, and are left out of the tables.\n", count,
                     results.runs.size(), results.options.time_limit_seconds);
}

}  // namespace

std::vector<std::string> write_scaling_report(const std::filesystem::path& folder, const ScalingResults& results) {
  return write_report(folder,
                      {.name = "scaling",
                       .introduction = "# Scaling\n\n" + setting(results) + thread_check(results) + cut_off(results),
                       .tables = scaling_tables(results),
                       .details = {scaling_runs_table(results)},
                       .figures = scaling_figures(results)});
}

}  // namespace cloud2csg
