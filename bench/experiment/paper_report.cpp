#include "bench/experiment/paper_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/experiment/figures.hpp"
#include "bench/experiment/paper_tables.hpp"
#include "bench/experiment/report_files.hpp"

namespace cloud2csg {
namespace {

std::string setting(const PaperResults& results) {
  const PaperOptions& options = results.options;
  const auto [first, last] =
      std::minmax_element(results.runs.begin(), results.runs.end(),
                          [](const PaperRun& a, const PaperRun& b) { return a.finished < b.finished; });
  return fmt::format(
      "{}; runs from {} to {}.\n"
      "Preset {}, evaluator {}, noise {}, {} repeats with seeds {} to {} for the search, one cloud a model and "
      "sampling (seed {}).\n"
      "Parallel modes use {} threads. Mean ± standard deviation over the repeats.\n",
      describe(results.environment), first->finished, last->finished, to_string(options.preset),
      to_string(options.evaluator), options.noise, options.repeats, options.seed, options.seed + options.repeats - 1,
      options.seed, options.threads);
}

std::string mode_check(const PaperResults& results) {
  const std::vector<std::string> disagreements = mode_disagreements(results);
  if (disagreements.empty()) {
    return fmt::format(
        "Every mode of a strategy gave the same tree for the same model, sampling and seed, in all {} runs.\n",
        results.runs.size());
  }
  return fmt::format("**Modes of the same strategy and seed gave different trees**, which must not be:\n- {}\n",
                     fmt::join(disagreements, "\n- "));
}

TableReport report_of(const PaperResults& results) {
  return {.name = "paper",
          .introduction = "# The paper's evaluation\n\n" + setting(results) + '\n' + mode_check(results),
          .tables = paper_tables(results),
          .details = {runs_table(results)},
          .figures = paper_figures(results)};
}

}  // namespace

std::vector<std::string> mode_disagreements(const PaperResults& results) {
  const auto strategy = [](const PaperRun& run) { return paper_mode(run.name.mode).strategy; };
  std::vector<std::string> disagreements;
  for (auto run = results.runs.begin(); run != results.runs.end(); ++run) {
    const auto first = std::find_if(results.runs.begin(), run, [&](const PaperRun& other) {
      return other.name.model == run->name.model && other.name.sampling == run->name.sampling &&
             other.name.seed == run->name.seed && strategy(other) == strategy(*run);
    });
    if (first == run || first->formula == run->formula) continue;
    disagreements.push_back(fmt::format("{} {}, seed {}: {} and {}", run->name.model, to_string(run->name.sampling),
                                        run->name.seed, first->name.mode, run->name.mode));
  }
  return disagreements;
}

std::string paper_markdown(const PaperResults& results, bool has_pictures) {
  return to_markdown(report_of(results), has_pictures);
}

std::vector<std::string> write_paper_report(const std::filesystem::path& folder, const PaperResults& results) {
  return write_report(folder, report_of(results));
}

}  // namespace cloud2csg
