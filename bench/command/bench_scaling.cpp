#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "bench/command/bench_command.hpp"
#include "bench/experiment/scaling.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg::app {
namespace {

struct ScalingCommand {
  std::string folder;
  std::vector<std::string> families;
  ScalingOptions experiment;
  RunOptions running;

  void run(std::stop_token stop) const;
};

void ScalingCommand::run(std::stop_token stop) const {
  Session session(running, std::move(stop));
  ScalingOptions options = experiment;
  options.threads = threads_of(running);
  if (!families.empty()) options.families.clear();
  for (const std::string& name : families) options.families.push_back(family_of(name));
  validate(options);
  make_folder(folder);
  const ScalingResults results =
      resumable(folder, session, [&] { return measure_scaling(options, folder, session.run()); });
  for (const std::string& note : write_scaling_report(folder, results)) session.display().note("note: " + note);
  session.display().note(fmt::format("{} runs; tables and figures are in {}", results.runs.size(),
                                     (std::filesystem::path(folder) / "scaling.md").string()));
  const std::vector<std::string> disagreements = thread_disagreements(results);
  if (disagreements.empty()) return;
  throw Error({.file = {},
               .where = disagreements.front(),
               .expected = "gave different trees, and threads must not",
               .remedy = "report it with scaling.json"});
}

/// An option that may be repeated; what is given takes the place of the default.
void add_sizes(CLI::App& app, const std::string& name, std::vector<std::size_t>& sizes, std::uint64_t least,
               std::uint64_t most, const std::string& help) {
  app.add_option(name, sizes, help)
      ->transform(whole_number(least, most))
      ->type_name("N")
      ->group("Experiment")
      ->capture_default_str();
}

void add_options(CLI::App& app, ScalingCommand& command) {
  constexpr std::uint64_t k_most_primitives = 1'000'000;
  constexpr std::uint64_t k_most_points = 1'000'000'000;
  constexpr std::uint64_t k_most_clique = 20;
  add_results_folder(app, command.folder);
  std::vector<std::string> names;
  names.reserve(all_families().size());
  for (const Family family : all_families()) names.emplace_back(to_string(family));
  app.add_option("--family", command.families,
                 fmt::format("Models of this family: {}\n(default: all but panel)", fmt::join(names, ", ")))
      ->check(one_of(names))
      ->type_name("NAME ...")
      ->group("Experiment");
  ScalingOptions& experiment = command.experiment;
  add_sizes(app, "--primitives", experiment.primitives, 1, k_most_primitives, "Sizes of models");
  add_whole_number(app, "--points-per-primitive", experiment.points_per_primitive, 1, "Points of these, by primitive");
  add_whole_number(app, "--at-points", experiment.at_points, 1, "Points of these in all, measured as well");
  add_sizes(app, "--points", experiment.points, 1, k_most_points, "Sizes of clouds");
  add_whole_number(app, "--at-primitives", experiment.at_primitives, 1, "Primitives of their model");
  add_sizes(app, "--cliques", experiment.cliques, 2, k_most_clique, "Sizes of cliques, of family random");
  app.add_option("--noise", experiment.noise, "Standard deviation by which each coordinate is moved")
      ->check(number_not_negative())
      ->type_name("SIGMA")
      ->group("Experiment")
      ->capture_default_str();
  add_whole_number(app, "--repeats", experiment.repeats, 1, "Runs of each size, with a seed each");
  add_whole_number(app, "--seed", experiment.seed, 0, "Of model, cloud and search of the first repeat");
  app.add_option("--time-limit", experiment.time_limit_seconds, "Seconds for the search of a run; 0: no limit")
      ->check(number_not_negative())
      ->type_name("SECONDS")
      ->group("Experiment")
      ->capture_default_str();
  add_run_options(app, command.running);
}

}  // namespace

Command add_bench_scaling(CLI::App& bench) {
  CLI::App* app = bench.add_subcommand("scaling", "Time and memory against size, on families of models of any size");
  app->footer("Finished runs are kept in DIR/scaling.json: after an interrupt the same command goes on.\n\n" +
              example("  cloud2csg bench scaling -o out/scaling\n"
                      "  cloud2csg bench scaling -o out/large --family grid --primitives 100 1000 10000 --repeats 1"));
  auto command = std::make_shared<ScalingCommand>();
  add_options(*app, *command);
  return {.options = app, .run = [command](std::stop_token stop) { command->run(std::move(stop)); }};
}

}  // namespace cloud2csg::app
