#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/run_context.hpp"
#include "progress_display.hpp"

namespace cloud2csg::app {

/// A subcommand: its options, bound to values of its own, and what it does with them.
/// @throws (by run) Error, Cancelled
struct Command {
  CLI::App* options;
  std::function<void(std::stop_token)> run;
};

// Each adds its subcommand to the program; one file a subcommand.
[[nodiscard]] Command add_extract(CLI::App& program);
[[nodiscard]] Command add_sample(CLI::App& program);
[[nodiscard]] Command add_scan(CLI::App& program);
[[nodiscard]] Command add_detect(CLI::App& program);
[[nodiscard]] Command add_compare(CLI::App& program);
[[nodiscard]] Command add_convert(CLI::App& program);
[[nodiscard]] Command add_view(CLI::App& program);
[[nodiscard]] Command add_info(CLI::App& program);
[[nodiscard]] Command add_bench(CLI::App& program);
[[nodiscard]] Command add_doctor(CLI::App& program);
[[nodiscard]] Command add_completion(CLI::App& program);
[[nodiscard]] Command add_manual(CLI::App& program);

/// Options that every subcommand with work to do has; with them go --config and --print-config (config.hpp).
struct RunOptions {
  int threads = 0;  ///< 0 = all cores
  bool quiet = false;
};
void add_run_options(CLI::App& options, RunOptions& values);

/// Progress on standard error while it lives.
class Session {
 public:
  Session(const RunOptions& options, std::stop_token stop);
  [[nodiscard]] const RunContext& run() const { return run_; }
  [[nodiscard]] ProgressDisplay& display() { return display_; }
  /// A note each.
  void warn(const std::vector<std::string>& warnings);

 private:
  ProgressDisplay display_;
  RunContext run_;
};

/// `-o FILE`, as often as wanted, at least once.
CLI::Option* add_outputs(CLI::App& options, std::vector<std::string>& files, const std::string& endings);

/// A required file to read, as an option or by its place.
CLI::Option* add_file(CLI::App& options, const std::string& name, std::string& file, const std::string& help);

/// @throws Error naming the file when the model has no tree.
[[nodiscard]] const CsgTree& tree_of(const Model& model, const std::string& file);

/// What `work` returns. An Error that names no file, of a stage that knows none, gets the name of what was worked on.
template <typename Work>
auto naming(const std::string& files, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (!error.parts().file.empty()) throw;
    Error::Parts parts = error.parts();
    parts.file = files;
    throw Error(std::move(parts));
  }
}

/// The example that ends a subcommand's help.
[[nodiscard]] std::string example(const std::string& lines);

}  // namespace cloud2csg::app
