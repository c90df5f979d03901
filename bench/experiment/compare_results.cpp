#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "bench/experiment/paper.hpp"
#include "bench/experiment/paper_tables.hpp"
#include "bench/experiment/resume_check.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

struct ComparedMeasure {
  const char* name;
  double (*value)(const PaperRun&);
  bool is_time;
};

constexpr std::array<ComparedMeasure, 4> k_measures{
    {{"duration, ms", &milliseconds, true},
     {"nodes", [](const PaperRun& run) { return static_cast<double>(run.tree.size); }, false},
     {"rms distance", [](const PaperRun& run) { return run.fit.rms_distance; }, false},
     {"evaluations", [](const PaperRun& run) { return static_cast<double>(run.evaluations); }, false}}};

/// All options except repeats and seeds must be equal.
void check_comparable(const PaperOptions& a, const PaperOptions& b) {
  for_each_field<PaperOptions>([&](auto member, const OptionField& field) {
    if (field.name == "repeats" || field.name == "seed" || a.*member == b.*member) return;
    throw Error({.where = spaced(field.name),
                 .expected = fmt::format("the results cannot be compared: {} and {}", value_text(a.*member),
                                         value_text(b.*member)),
                 .remedy = "compare results of the same options"});
  });
}

Difference judge(const Change& change, double least_change, double error_rate) {
  if (change.before.count < 2 || change.after.count < 2) return Difference::unknown;
  // Not the relative change: it does not exist for a mean of 0 before.
  const double difference = change.after.mean - change.before.mean;
  const bool matters = std::abs(difference) >= least_change * std::abs(change.before.mean);
  if (difference == 0 || !matters || welch_test(change.before, change.after) >= error_rate) return Difference::same;
  return difference > 0 ? Difference::worse : Difference::better;
}

double relative_change(const Spread& before, const Spread& after) {
  return before.mean == 0 ? 0 : after.mean / before.mean - 1;
}

std::vector<Change> measured_changes(const PaperResults& before, const PaperResults& after) {
  std::vector<Change> changes;
  for (const ComparedMeasure& compared : k_measures) {
    for (const std::string& model : before.options.models) {
      for (const Sampling sampling : {Sampling::low, Sampling::high}) {
        for (const PaperMode& mode : paper_modes()) {
          if (!compared.is_time && mode.parallel != Parallel::none) continue;
          Change change{.model = model,
                        .sampling = sampling,
                        .mode = std::string(mode.name),
                        .measure = compared.name,
                        .before = measure(before, model, sampling, mode.name, compared.value),
                        .after = measure(after, model, sampling, mode.name, compared.value)};
          change.relative = relative_change(change.before, change.after);
          changes.push_back(std::move(change));
        }
      }
    }
  }
  return changes;
}

}  // namespace

std::vector<Change> compare_paper_results(const PaperResults& before, const PaperResults& after,
                                          const ResultComparisonOptions& options) {
  check_comparable(before.options, after.options);
  std::vector<Change> changes = measured_changes(before, after);
  const double error_rate = options.error_rate / static_cast<double>(changes.size());
  for (Change& change : changes) {
    const bool is_time = change.measure == k_measures.front().name;
    change.difference = judge(change, is_time ? options.least_time_change : options.least_change, error_rate);
  }
  return changes;
}

std::string changes_markdown(std::span<const Change> changes) {
  Table table{.name = "changes",
              .title = "Changes",
              .columns = {"model", "sampling", "mode", "measure", "before", "after", "change", "difference"}};
  for (const Change& change : changes) {
    table.rows.push_back({change.model, std::string(to_string(change.sampling)), change.mode, change.measure,
                          change.before, change.after, fmt::format("{:+.1f} %", 100 * change.relative),
                          std::string(to_string(change.difference))});
  }
  return to_markdown(table);
}

}  // namespace cloud2csg
