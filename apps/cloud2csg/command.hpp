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

/// What the last of these words of a command line, which may be empty, can become: a line each, with a tab and what it
/// means behind it. Instead of files stands one line: `:files:BEFORE:ENDINGS`, where BEFORE is what the word has before
/// the name of the file ("--output="), and no ENDINGS (".ply .pcd") stand for any. The scripts of `completion` ask for
/// it by `cloud2csg complete WORD...`.
[[nodiscard]] std::string completions(CLI::App& program, std::span<const std::string> words);

/// RunOptions, and with them --config and --print-config.
void add_run_options(CLI::App& options, RunOptions& values);

/// Adds --config FILE and --print-config to a command.
///
/// The file is TOML: options by their long names without dashes (`leaf-cost = 0.001`, flags `quiet = true`,
/// `seeds = false` for --no-seeds), lists for what may be repeated. They stand in the table of their command
/// (`[extract]`, `[bench.paper]`), or before all tables, for every command that has them. What the command line says
/// wins, also over what it excludes. A name that no command has is refused with its line and the nearest right one.
///
/// The reader of CLI11 is not used: it takes any text for TOML, ends values at a # within quotes, and names no lines.
void add_config_options(CLI::App& command);

/// Ends the parsing of a command line by which the configuration is to be printed: what() is its text.
class PrintedConfig : public CLI::Success {
 public:
  explicit PrintedConfig(std::string text) : CLI::Success("PrintedConfig", std::move(text), CLI::ExitCodes::Success) {}
};

/// `-o FILE`, as often as wanted, at least once.
CLI::Option* add_outputs(CLI::App& options, std::vector<std::string>& files, const std::string& endings);

/// A required file to read, as an option or by its place.
CLI::Option* add_file(CLI::App& options, const std::string& name, std::string& file, const std::string& help);

/// What a cloud is to be made of.
void add_shape(CLI::App& options, std::string& file);

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

/// What is wrong with the command line, and found only when the command runs.
class WrongUsage : public Error {
 public:
  using Error::Error;
};

/// Which command takes a file of this kind, where another one was given it.
[[nodiscard]] const char* taker_of(FileKind kind);

/// Whether a command was named that is only the first word of others, and nothing behind it.
[[nodiscard]] bool lacks_command(const CLI::App& program);

/// One line that says what is wrong with the command line, with the nearest right name for a wrong one.
[[nodiscard]] std::string usage_message(const CLI::App& program, const CLI::ParseError& error);

/// CLI11's message in clearer words, where it has none.
[[nodiscard]] std::string reworded(const CLI::ParseError& error);

/// "; did you mean 'extract'?", or nothing when no candidate is near enough to `word` to be meant.
[[nodiscard]] std::string suggestion(std::string_view word, std::span<const std::string> candidates);

/// The example that ends a subcommand's help.
[[nodiscard]] std::string example(const std::string& lines);

}  // namespace cloud2csg::app
