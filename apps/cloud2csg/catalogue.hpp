#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/// The program's visible commands, options and arguments, for manual pages, completions and printed configurations.
namespace cloud2csg::app {

[[nodiscard]] std::vector<CLI::App*> commands_of(CLI::App& command);
/// The command and all nested ones, outer ones first.
[[nodiscard]] std::vector<CLI::App*> all_commands(CLI::App& command);
/// Positional arguments.
[[nodiscard]] std::vector<CLI::Option*> arguments_of(CLI::App& command);
/// Named options, grouped in the order of each group's first option.
[[nodiscard]] std::vector<CLI::Option*> options_of(CLI::App& command);

/// "-o", "--output"
[[nodiscard]] std::vector<std::string> dashed_names(const CLI::Option& option);
/// False for flags.
[[nodiscard]] bool takes_value(const CLI::Option& option);

/// "cloud2csg bench paper"
[[nodiscard]] std::string path_text(const CLI::App& command, const std::string& separator = " ");

[[nodiscard]] std::string replaced(std::string text, const std::string& part, const std::string& by);

}  // namespace cloud2csg::app
