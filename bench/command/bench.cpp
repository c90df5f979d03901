#include <algorithm>
#include <filesystem>
#include <system_error>

#include "bench/command/bench_command.hpp"
#include "bench/experiment/paper.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg::app {

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (!std::filesystem::is_directory(folder)) {
    throw Error({.file = folder.string(),
                 .expected = "the folder cannot be created: " +
                             (failure ? failure.message() : std::string("a file of this name exists"))});
  }
}

void add_results_folder(CLI::App& app, std::string& folder) {
  app.add_option("-o,--output", folder, "Folder for the results; created if it does not exist")
      ->check(file_name())
      ->required()
      ->type_name("DIR")
      ->group("Output");
}

int threads_of(const RunOptions& running) {
  const int cores = current_environment().cores;
  return running.threads == 0 ? cores : std::min(running.threads, cores);
}

Command add_bench(CLI::App& program) {
  CLI::App* app =
      program.add_subcommand("bench", "Measures the method: the paper's evaluation, and how time and memory scale");
  app->footer(example("  cloud2csg bench paper -o out/paper"));
  app->require_subcommand(1);
  std::vector<Command> experiments{add_bench_paper(*app), add_bench_scaling(*app), add_bench_compare(*app)};
  return {.options = app, .run = [experiments = std::move(experiments)](const std::stop_token& stop) {
            for (const Command& experiment : experiments) {
              if (experiment.options->parsed()) return experiment.run(stop);
            }
            return k_done;
          }};
}

}  // namespace cloud2csg::app
