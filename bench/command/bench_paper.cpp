#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "bench/command/bench_command.hpp"
#include "bench/experiment/paper.hpp"
#include "cloud2csg/error.hpp"
#include "field_arguments.hpp"
#include "installation.hpp"

namespace cloud2csg::app {
namespace {

struct PaperCommand {
  std::optional<std::string> models;
  std::vector<std::string> only;
  std::string folder;
  PaperOptions experiment;
  RunOptions running;

  void prepare();
  void run(std::stop_token stop) const;
  [[nodiscard]] std::filesystem::path models_folder() const;
};

std::filesystem::path PaperCommand::models_folder() const {
  if (models) return *models;
  if (auto shipped = shipped_models()) return *shipped;
  throw Error(
      {.expected = "the shipped models are not beside the program", .remedy = "give their folder with --models"});
}

/// Sorted names of all models in a folder.
std::vector<std::string> model_names(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  if (names.empty()) {
    throw Error({.file = folder.string(),
                 .expected = failure ? failure.message() : std::string("no model files (.json) in this folder"),
                 .remedy = "give a folder of models with --models"});
  }
  std::sort(names.begin(), names.end());
  return names;
}

void PaperCommand::prepare() {
  experiment.models = only.empty() ? model_names(models_folder()) : only;
  experiment.threads = threads_of(running);
}

void PaperCommand::run(std::stop_token stop) const {
  Session session(running, std::move(stop));
  make_folder(folder);
  const PaperResults results =
      resumable(folder, session, [&] { return reproduce_paper(experiment, models_folder(), folder, session.run()); });
  for (const std::string& note : write_paper_report(folder, results)) session.display().note("note: " + note);
  session.display().note(fmt::format(
      "{} runs; tables and figures are in {}", results.runs.size(),
      (std::filesystem::path(folder) / "gave different trees; all modes must give the same tree").string()));
  const std::vector<std::string> disagreements = mode_disagreements(results);
  if (disagreements.empty()) return;
  throw Error({.where = disagreements.front(),
               .expected = "report this with paper.json",
               .remedy = "report it with paper.json"});
}

void add_options(CLI::App& app, PaperCommand& command, FieldArguments& fields) {
  add_results_folder(app, command.folder);
  app.add_option("--models", command.models, "Folder of models with trees (default: the shipped models)")
      ->check(file_name())
      ->type_name("DIR")
      ->group("Experiment");
  app.add_option("--only", command.only,
                 "Name of a model in the folder, without its ending; may be repeated (default: all)")
      ->check(file_name())
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->group("Experiment");
  fields.add(command.experiment, {.group = "Experiment"});
}

}  // namespace

Command add_bench_paper(CLI::App& bench) {
  CLI::App* app =
      bench.add_subcommand("paper", "Repeats the paper's evaluation of its models and modes, with tables and figures");
  app->footer("Finished runs are kept in DIR/paper.json: after an interrupt, the same command continues.\n\n" +
              example("  cloud2csg bench paper -o out/paper"));
  return make_command<PaperCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
