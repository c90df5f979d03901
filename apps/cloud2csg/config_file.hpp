#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace cloud2csg::app {

/// Adds --config FILE and --print-config to a command.
///
/// The file is TOML: options by their long names without dashes (`leaf-cost = 0.001`, `snap`-like flags `quiet = true`,
/// `seeds = false` for --no-seeds), lists for what may be repeated. They stand in the table of their command
/// (`[extract]`, `[bench.paper]`), or before all tables, for every command that has them. What the command line says
/// wins, also over what it excludes. A name that no command has is refused with its line and the nearest right one.
void add_config_options(CLI::App& command);

/// Sets the options of `command` that the file gives and the command line did not.
/// @throws CLI::ConfigError naming file, line and key
void apply_config(CLI::App& command, const std::string& file);

/// The command's options in force as such a file: those without a value are comments.
[[nodiscard]] std::string config_text(CLI::App& command);

/// Ends the parsing of a command line by which the configuration is to be printed: what() is its text.
class PrintedConfig : public CLI::Success {
 public:
  explicit PrintedConfig(std::string text) : CLI::Success("PrintedConfig", std::move(text), CLI::ExitCodes::Success) {}
};

}  // namespace cloud2csg::app
