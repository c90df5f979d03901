#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/model.hpp"
#include "io/formats/formats.hpp"
#include "session.hpp"

namespace cloud2csg::app {

// Exit statuses.
inline constexpr int k_done = 0;
inline constexpr int k_failed = 1;
inline constexpr int k_wrong_usage = 2;
inline constexpr int k_doubtful = 3;  ///< files are written, but the result's verdict is `doubtful`

/// A subcommand: its options, bound to their values, and its action.
struct Command {
  CLI::App* options;
  std::function<int(std::stop_token)> run;  ///< returns the exit status. @throws Error, Cancelled
  std::function<void(std::string_view)> fail =
      {};  ///< tells of a failed run() on standard output, where that is asked for
};

// Each adds its subcommand to the program; one file per subcommand.
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

/// Completions of the last word, maybe empty, of a command line: one per line, with a tab and its meaning. The line
/// `:files:BEFORE:ENDINGS` stands for files. BEFORE is the word's part before the file name ("--output="); without
/// ENDINGS (".ply .pcd") all files match. The scripts of `completion` call `cloud2csg complete WORD...`.
[[nodiscard]] std::string completions(CLI::App& program, std::span<const std::string> words);

void add_run_options(CLI::App& options, RunOptions& values);

/// Adds --config FILE and --print-config to a command.
///
/// The file is TOML. Keys are long options without dashes (`leaf-cost = 0.001`, flags `quiet = true`, `seeds = false`
/// for --no-seeds); repeatable options take lists. They stand in their command's table (`[extract]`, `[bench.paper]`),
/// or before all tables for every command that has them. The command line wins, also over options that it excludes.
/// Unknown names are refused with their line and the nearest known name.
///
/// CLI11's reader is unsuitable: it takes any text for TOML, ends values at a # within quotes, and names no lines.
void add_config_options(CLI::App& command);

/// Ends the parsing when the configuration is to be printed; what() is its text.
class PrintedConfig : public CLI::Success {
 public:
  explicit PrintedConfig(std::string text) : CLI::Success("PrintedConfig", std::move(text), CLI::ExitCodes::Success) {}
};

/// `-o FILE`, repeatable, required.
CLI::Option* add_outputs(CLI::App& options, std::vector<std::string>& files, const std::string& endings);

/// A required input file, as an option or a positional argument.
CLI::Option* add_file(CLI::App& options, const std::string& name, std::string& file, const std::string& help);

void add_shape(CLI::App& options, std::string& file);

/// The result of `work`. Adds `files` to an Error that names no file.
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

/// An error in the command line that shows only when the command runs.
class WrongUsage : public Error {
 public:
  using Error::Error;
};

/// The command that takes a file of this kind, to suggest it in place of another.
[[nodiscard]] const char* taker_of(FileKind kind);

/// Whether the last named command needs a subcommand and has none.
[[nodiscard]] bool lacks_command(const CLI::App& program);

/// One line about the error in the command line, with the nearest known name for an unknown one.
[[nodiscard]] std::string usage_message(const CLI::App& program, const CLI::ParseError& error);

/// CLI11's message in clearer words, where possible.
[[nodiscard]] std::string reworded(const CLI::ParseError& error);

/// "; did you mean 'extract'?", or nothing when no candidate is near enough.
[[nodiscard]] std::string suggestion(std::string_view word, std::span<const std::string> candidates);

[[nodiscard]] std::string example(const std::string& lines);

}  // namespace cloud2csg::app
