#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "bench/command/bench_command.hpp"
#include "bench/experiment/paper.hpp"
#include "cloud2csg/error.hpp"
#include "field_arguments.hpp"

namespace cloud2csg::app {
namespace {

struct CompareResultsCommand {
  std::string before;
  std::string after;
  ResultComparisonOptions comparing;
  bool is_all = false;

  void run(const std::stop_token& stop) const;
};

std::size_t count_of(std::span<const Change> changes, Difference difference) {
  return static_cast<std::size_t>(std::count_if(
      changes.begin(), changes.end(), [difference](const Change& change) { return change.difference == difference; }));
}

void CompareResultsCommand::run(const std::stop_token& /*stop*/) const {
  const PaperResults results_before = read_paper_results(before);
  const PaperResults results_after = read_paper_results(after);
  const std::vector<Change> changes = naming(
      before + " with " + after, [&] { return compare_paper_results(results_before, results_after, comparing); });
  std::vector<Change> shown;
  std::copy_if(changes.begin(), changes.end(), std::back_inserter(shown),
               [this](const Change& change) { return is_all || change.difference != Difference::same; });
  if (!shown.empty()) fmt::print("{}\n", changes_markdown(shown));
  const Environment& machine_before = results_before.environment;
  const Environment& machine_after = results_after.environment;
  if (machine_before.cpu != machine_after.cpu || machine_before.cores != machine_after.cores) {
    fmt::print("The machines differ ({}, {} cores; {}, {} cores), and so do durations.\n", machine_before.cpu,
               machine_before.cores, machine_after.cpu, machine_after.cores);
  }
  const std::size_t worse = count_of(changes, Difference::worse);
  fmt::print("{} measures: {} worse, {} better, {} the same within the noise, {} unknown\n", changes.size(), worse,
             count_of(changes, Difference::better), count_of(changes, Difference::same),
             count_of(changes, Difference::unknown));
  if (worse == 0) return;
  throw Error({.file = after, .expected = fmt::format("{} measures got worse", worse)});
}

void add_options(CLI::App& app, CompareResultsCommand& command, FieldArguments& fields) {
  add_file(app, "before", command.before, "Results to compare with (a paper.json)")->type_name("BEFORE.json");
  add_file(app, "after", command.after, "Results to judge (a paper.json)")->type_name("AFTER.json");
  app.add_flag("--all", command.is_all, "Also show measures that stayed the same")->group("Output");
  fields.add(command.comparing, {.group = "Judgement"});
}

}  // namespace

Command add_bench_compare(CLI::App& bench) {
  CLI::App* app =
      bench.add_subcommand("compare", "Shows what got slower or larger between two results of 'bench paper'");
  app->footer(
      "A measure is better or worse if Welch's t-test over the repeats finds a difference and the change is large "
      "enough.\nExit status 1 if a measure got worse.\n\n" +
      example("  cloud2csg bench compare before/paper.json after/paper.json"));
  return make_command<CompareResultsCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
