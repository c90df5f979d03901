#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

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
[[nodiscard]] Command add_compare(CLI::App& program);
[[nodiscard]] Command add_convert(CLI::App& program);
[[nodiscard]] Command add_info(CLI::App& program);

/// Options that every subcommand with work to do has.
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

 private:
  ProgressDisplay display_;
  RunContext run_;
};

/// `-o FILE`, as often as wanted, at least once.
CLI::Option* add_outputs(CLI::App& options, std::vector<std::string>& files, const std::string& endings);

/// Accepts finite numbers of 0 or more. (CLI11's own NonNegativeNumber accepts not-a-number.)
[[nodiscard]] CLI::Validator finite_not_negative();

/// The example that ends a subcommand's help.
[[nodiscard]] std::string example(const std::string& lines);

}  // namespace cloud2csg::app
