#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>

namespace cloud2csg::app {

/// Adds --config FILE and --print-config to a command.
///
/// The file is TOML: options by their long names without dashes (`leaf-cost = 0.001`, `snap`-like flags `quiet = true`,
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

}  // namespace cloud2csg::app
