#include <fmt/format.h>

#include <filesystem>

#include "bench/command/bench_command.hpp"
#include "bench/experiment/scaling.hpp"
#include "cloud2csg/error.hpp"
#include "field_arguments.hpp"

namespace cloud2csg::app {
namespace {

struct ScalingCommand {
  std::string folder;
  ScalingOptions experiment;
  RunOptions running;

  void prepare() { experiment.threads = threads_of(running); }
  void run(std::stop_token stop) const;
};

void ScalingCommand::run(std::stop_token stop) const {
  Session session(running, std::move(stop));
  make_folder(folder);
  const ScalingResults results =
      resumable(folder, session, [&] { return measure_scaling(experiment, folder, session.run()); });
  for (const std::string& note : write_scaling_report(folder, results)) session.display().note("note: " + note);
  session.display().note(fmt::format("{} runs; tables and figures are in {}", results.runs.size(),
                                     (std::filesystem::path(folder) / "scaling.md").string()));
  const std::vector<std::string> disagreements = thread_disagreements(results);
  if (disagreements.empty()) return;
  throw Error({.where = disagreements.front(),
               .expected = "gave different trees; any number of threads must give the same tree",
               .remedy = "report this with scaling.json"});
}

void add_options(CLI::App& app, ScalingCommand& command, FieldArguments& fields) {
  add_results_folder(app, command.folder);
  fields.add(command.experiment, {.group = "Experiment"});
}

}  // namespace

Command add_bench_scaling(CLI::App& bench) {
  CLI::App* app =
      bench.add_subcommand("scaling", "Measures time and memory against size, on families of models of any size");
  app->footer("Finished runs are kept in DIR/scaling.json: after an interrupt, the same command continues.\n\n" +
              example("  cloud2csg bench scaling -o out/scaling\n"
                      "  cloud2csg bench scaling -o out/large --family grid --primitives 100 1000 10000 --repeats 1"));
  return make_command<ScalingCommand>(*app, add_options);
}

}  // namespace cloud2csg::app
