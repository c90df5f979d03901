#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/// What the help shows of the program: its commands, options and arguments, less those without a group, which are
/// hidden. Manual pages, completions and printed configurations are made of these.
namespace cloud2csg::app {

/// Those right inside of it.
[[nodiscard]] std::vector<CLI::App*> commands_of(CLI::App& command);
/// The command and all inside of it, outer ones first.
[[nodiscard]] std::vector<CLI::App*> all_commands(CLI::App& command);
/// What goes by its place.
[[nodiscard]] std::vector<CLI::Option*> arguments_of(CLI::App& command);
/// What has a name, those of a group together where its first is.
[[nodiscard]] std::vector<CLI::Option*> options_of(CLI::App& command);

/// "-o", "--output"
[[nodiscard]] std::vector<std::string> dashed_names(const CLI::Option& option);
/// Whether it is more than a flag.
[[nodiscard]] bool takes_value(const CLI::Option& option);

/// "cloud2csg bench paper"
[[nodiscard]] std::string path_text(const CLI::App& command, const std::string& separator = " ");

/// The text with each occurrence of a part replaced.
[[nodiscard]] std::string replaced(std::string text, const std::string& part, const std::string& by);

}  // namespace cloud2csg::app
