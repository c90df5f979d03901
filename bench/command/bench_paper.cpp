#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include "bench/command/bench_command.hpp"
#include "bench/experiment/paper.hpp"
#include "cloud2csg/error.hpp"
#include "installation.hpp"

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

std::filesystem::path default_models() {
  if (auto folder = shipped_models()) return *folder;
  throw Error({.file = {},
               .where = {},
               .expected = "the shipped models are not beside the program",
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

void PaperCommand::run(std::stop_token stop) const {
  Session session(running, std::move(stop));
  const std::filesystem::path folder_of_models = models ? std::filesystem::path(*models) : default_models();
  PaperOptions options = experiment;
  options.models = only.empty() ? model_names(folder_of_models) : only;
  options.threads = threads_of(running);
  make_folder(folder);
  const PaperResults results =
      resumable(folder, session, [&] { return reproduce_paper(options, folder_of_models, folder, session.run()); });
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

void add_options(CLI::App& app, PaperCommand& command) {
  add_results_folder(app, command.folder);
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

}  // namespace

Command add_bench_paper(CLI::App& bench) {
  CLI::App* app = bench.add_subcommand("paper", "The paper's evaluation: its models and modes, as tables and figures");
  app->footer("Finished runs are kept in DIR/paper.json: after an interrupt the same command goes on.\n\n" +
              example("  cloud2csg bench paper -o out/paper"));
  auto command = std::make_shared<PaperCommand>();
  add_options(*app, *command);
  app->final_callback([command] { check_together(command->experiment); });
  return {.options = app, .run = [command](std::stop_token stop) { command->run(std::move(stop)); }};
}

}  // namespace cloud2csg::app
