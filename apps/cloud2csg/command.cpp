#include "command.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace cloud2csg::app {

void add_run_options(CLI::App& options, RunOptions& values) {
  options.add_option("--threads", values.threads, "Threads to use; 0 = all cores")
      ->check(CLI::Range(0, 1024))
      ->type_name("N")
      ->group("Running")
      ->capture_default_str();
  options.add_flag("-q,--quiet", values.quiet, "No progress and no notes on standard error")->group("Running");
}

Session::Session(const RunOptions& options, std::stop_token stop)
    : display_(stderr, progress_style(stderr, options.quiet)),
      run_{.stop = std::move(stop),
           .on_progress = [this](const Progress& progress) { display_.update(progress); },
           .threads = options.threads} {}

CLI::Option* add_outputs(CLI::App& options, std::vector<std::string>& files, const std::string& endings) {
  return options
      .add_option("-o,--output", files, fmt::format("File to write, by its ending: {}; may be repeated", endings))
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("Output");
}

CLI::Validator finite_not_negative() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0;
    if (!CLI::detail::lexical_cast(text, value)) return fmt::format("'{}' is not a number", text);
    return std::isfinite(value) && value >= 0 ? std::string() : fmt::format("{} is not a finite number >= 0", text);
  };
  return {check, ""};
}

std::string example(const std::string& lines) {
  return "Example:\n" + lines;
}

}  // namespace cloud2csg::app
