#include "command.hpp"

#include <fmt/format.h>

#include <utility>

#include "config.hpp"
#include "usage.hpp"
#include "values.hpp"

namespace cloud2csg::app {
void add_run_options(CLI::App& options, RunOptions& values) {
  options.add_option("--threads", values.threads, "Threads to use; 0 = all cores")
      ->transform(number_in<int>(from_to(0, 1024)))
      ->type_name("N")
      ->group("Running")
      ->capture_default_str();
  options.add_flag("-q,--quiet", values.quiet, "No progress and no notes on standard error")->group("Running");
  add_config_options(options);
}

Session::Session(const RunOptions& options, std::stop_token stop)
    : display_(stderr, progress_style(stderr, options.quiet)),
      run_{.stop = std::move(stop),
           .on_progress = [this](const Progress& progress) { display_.update(progress); },
           .threads = options.threads} {}

void Session::warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) display_.note("warning: " + warning);
}

CLI::Option* add_outputs(CLI::App& options, std::vector<std::string>& files, const std::string& endings) {
  return options
      .add_option("-o,--output", files, fmt::format("File to write, by its ending: {}; may be repeated", endings))
      ->check(file_name())
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("Output");
}

CLI::Option* add_file(CLI::App& options, const std::string& name, std::string& file, const std::string& help) {
  return options.add_option(name, file, help)->check(file_name())->required();
}

const CsgTree& tree_of(const Model& model, const std::string& file) {
  if (model.tree) return *model.tree;
  throw Error({.file = file,
               .where = "/tree",
               .expected = "the model has primitives but no tree",
               .remedy = "extract a tree from a cloud first, or add a \"tree\" that combines the primitives"});
}

std::string example(const std::string& lines) {
  return "Example:\n" + lines;
}

}  // namespace cloud2csg::app
