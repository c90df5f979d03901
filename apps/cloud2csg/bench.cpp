#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <system_error>

#include "cloud2csg/error.hpp"
#include "cloud2csg/experiment.hpp"
#include "command.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

struct PaperCommand {
  std::optional<std::string> models;
  std::vector<std::string> only;
  std::string folder;
  PaperOptions experiment;
  RunOptions running;

  void run(std::stop_token stop) const;
};

/// Where the shipped models are: beside an installed program, or in the build folder that the program is in.
std::filesystem::path shipped_models() {
  std::error_code failure;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failure);
  for (const char* place : {CLOUD2CSG_MODELS_FROM_PROGRAM, "share/cloud2csg/models"}) {
    std::filesystem::path folder = (program.parent_path() / place).lexically_normal();
    if (std::filesystem::is_directory(folder, failure)) return folder;
  }
  throw Error({.file = {},
               .where = {},
               .expected = fmt::format("the shipped models are not beside the program ({})", program.string()),
               .remedy = "name their folder by --models"});
}

/// All models of a folder, by name.
std::vector<std::string> model_names(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  if (names.empty()) {
    throw Error({.file = folder.string(),
                 .where = {},
                 .expected = failure ? failure.message() : std::string("no model files (.json) in this folder"),
                 .remedy = "name a folder of models by --models"});
  }
  std::sort(names.begin(), names.end());
  return names;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (!std::filesystem::is_directory(folder)) {
    throw Error({.file = folder.string(),
                 .where = {},
                 .expected = "the folder cannot be made: " +
                             (failure ? failure.message() : std::string("there is a file of this name")),
                 .remedy = {}});
  }
}

/// Says, when it is interrupted, how to go on.
PaperResults reproduce(const PaperCommand& command, const PaperOptions& options, const std::filesystem::path& models,
                       Session& session) {
  try {
    return reproduce_paper(options, models, command.folder, session.run());
  } catch (const Cancelled&) {
    session.display().note(
        fmt::format("finished runs are kept in {}; the same command makes those that are missing", command.folder));
    throw;
  }
}

void PaperCommand::run(std::stop_token stop) const {
  Session session(running, std::move(stop));
  const std::filesystem::path folder_of_models = models ? std::filesystem::path(*models) : shipped_models();
  PaperOptions options = experiment;
  options.models = only.empty() ? model_names(folder_of_models) : only;
  const int cores = current_environment().cores;
  options.threads = running.threads == 0 ? cores : std::min(running.threads, cores);
  make_folder(folder);
  const PaperResults results = reproduce(*this, options, folder_of_models, session);
  for (const std::string& note : write_paper_report(folder, results)) session.display().note("note: " + note);
  session.display().note(fmt::format("{} runs; tables and figures are in {}", results.runs.size(),
                                     (std::filesystem::path(folder) / "paper.md").string()));
  const std::vector<std::string> disagreements = mode_disagreements(results);
  if (disagreements.empty()) return;
  throw Error({.file = {},
               .where = disagreements.front(),
               .expected = "gave different trees, and modes must not",
               .remedy = "report it with paper.json"});
}

template <typename Value>
void add_whole_number(CLI::App& app, const std::string& name, Value& value, std::uint64_t least,
                      const std::string& help) {
  app.add_option(name, value, help)
      ->transform(whole_number_from(least))
      ->type_name("N")
      ->group("Experiment")
      ->capture_default_str();
}

void add_options(CLI::App& app, PaperCommand& command) {
  app.add_option("-o,--output", command.folder, "Folder for the results; made when it is not there")
      ->check(file_name())
      ->required()
      ->type_name("DIR")
      ->group("Output");
  PaperOptions& experiment = command.experiment;
  app.add_option("--models", command.models, "Folder of models with trees (default: those that are shipped)")
      ->check(file_name())
      ->type_name("DIR")
      ->group("Experiment");
  app.add_option("--only", command.only, "A model of the folder, without its ending; may be repeated (default: all)")
      ->check(file_name())
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->group("Experiment");
  add_whole_number(app, "--low-points", experiment.low_points, 1, "Points of a cloud, low sampling");
  add_whole_number(app, "--high-points", experiment.high_points, 2, "Points of a cloud, high sampling");
  app.add_option("--noise", experiment.noise, "Standard deviation by which each coordinate is moved")
      ->check(number_not_negative())
      ->type_name("SIGMA")
      ->group("Experiment")
      ->capture_default_str();
  add_whole_number(app, "--repeats", experiment.repeats, 1, "Runs of each mode, with a seed each");
  add_whole_number(app, "--seed", experiment.seed, 0, "Of the clouds and of the first repeat's search");
  app.add_option("--preset", experiment.preset, "paper: the paper's weights and search, nothing added; or default")
      ->check(one_of({"paper", "default"}))
      ->type_name("NAME")
      ->group("Experiment")
      ->capture_default_str();
  app.add_option("--evaluator", experiment.evaluator,
                 "classes; or reference: the paper's steps alone, each tree at each point, thousands of times slower")
      ->check(one_of({"classes", "reference"}))
      ->type_name("NAME")
      ->group("Experiment")
      ->capture_default_str();
  add_run_options(app, command.running);
}

/// Values that are each right, but not together. @throws CLI::ValidationError
void check_together(const PaperOptions& experiment) {
  if (experiment.low_points >= experiment.high_points) {
    throw CLI::ValidationError("--high-points", "expected more than --low-points");
  }
  if (experiment.evaluator == "reference" && experiment.preset != "paper") {
    throw CLI::ValidationError("--evaluator", "reference goes with --preset paper only");
  }
}

Command add_paper(CLI::App& bench) {
  CLI::App* app = bench.add_subcommand("paper", "The paper's evaluation: its models and modes, as tables and figures");
  app->footer("Finished runs are kept in DIR/paper.json: after an interrupt the same command goes on.\n\n" +
              example("  cloud2csg bench paper -o out/paper"));
  auto command = std::make_shared<PaperCommand>();
  add_options(*app, *command);
  app->final_callback([command] { check_together(command->experiment); });
  return {.options = app, .run = [command](std::stop_token stop) { command->run(std::move(stop)); }};
}

struct CompareResultsCommand {
  std::string before;
  std::string after;
  ResultComparisonOptions comparing;
  bool is_all = false;

  void run() const;
};

std::size_t count_of(std::span<const Change> changes, Verdict verdict) {
  return static_cast<std::size_t>(std::count_if(changes.begin(), changes.end(),
                                                [verdict](const Change& change) { return change.verdict == verdict; }));
}

void CompareResultsCommand::run() const {
  const PaperResults results_before = read_paper_results(before);
  const PaperResults results_after = read_paper_results(after);
  const std::vector<Change> changes = naming(
      before + " with " + after, [&] { return compare_paper_results(results_before, results_after, comparing); });
  std::vector<Change> shown;
  std::copy_if(changes.begin(), changes.end(), std::back_inserter(shown),
               [this](const Change& change) { return is_all || change.verdict != Verdict::same; });
  if (!shown.empty()) fmt::print("{}\n", changes_markdown(shown));
  const Environment& machine_before = results_before.environment;
  const Environment& machine_after = results_after.environment;
  if (machine_before.cpu != machine_after.cpu || machine_before.cores != machine_after.cores) {
    fmt::print("The machines differ ({}, {} cores; {}, {} cores): so do durations.\n", machine_before.cpu,
               machine_before.cores, machine_after.cpu, machine_after.cores);
  }
  const std::size_t worse = count_of(changes, Verdict::worse);
  fmt::print("{} measures: {} worse, {} better, {} the same within the noise, {} unknown\n", changes.size(), worse,
             count_of(changes, Verdict::better), count_of(changes, Verdict::same), count_of(changes, Verdict::unknown));
  if (worse == 0) return;
  throw Error(
      {.file = after, .where = {}, .expected = fmt::format("{} of its measures got worse", worse), .remedy = {}});
}

Command add_compare_results(CLI::App& bench) {
  CLI::App* app = bench.add_subcommand("compare", "What got slower or larger between two results of 'bench paper'");
  app->footer(
      "A measure is better or worse when Welch's t-test over the repeats says so and the change is large enough.\n"
      "Exit status 1 when one got worse.\n\n" +
      example("  cloud2csg bench compare before/paper.json after/paper.json"));
  auto command = std::make_shared<CompareResultsCommand>();
  add_file(*app, "before", command->before, "The paper.json to compare with")->type_name("BEFORE.json");
  add_file(*app, "after", command->after, "The paper.json to judge")->type_name("AFTER.json");
  app->add_flag("--all", command->is_all, "Show what stayed the same too")->group("Output");
  const auto add_share = [app](const std::string& name, double& value, const std::string& help) {
    app->add_option(name, value, help)->check(share())->type_name("SHARE")->group("Judgement")->capture_default_str();
  };
  add_share("--least-time-change", command->comparing.least_time_change, "Durations that differ by less are the same");
  add_share("--least-change", command->comparing.least_change, "... and nodes, distances and evaluations");
  add_share("--error-rate", command->comparing.error_rate, "Chance of any wrong verdict at all");
  return {.options = app, .run = [command](const std::stop_token&) { command->run(); }};
}

}  // namespace

Command add_bench(CLI::App& program) {
  CLI::App* app = program.add_subcommand("bench", "Measures the method as its paper did");
  app->footer(example("  cloud2csg bench paper -o out/paper"));
  app->require_subcommand(1);
  std::vector<Command> experiments{add_paper(*app), add_compare_results(*app)};
  return {.options = app, .run = [experiments = std::move(experiments)](const std::stop_token& stop) {
            for (const Command& experiment : experiments) {
              if (experiment.options->parsed()) experiment.run(stop);
            }
          }};
}

}  // namespace cloud2csg::app
