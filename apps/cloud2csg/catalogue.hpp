#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/// The program's commands and options as plain values: what manual pages, completions and printed configurations are
/// made of.
namespace cloud2csg::app {

struct OptionEntry {
  std::vector<std::string> names;    ///< "-o", "--output"; the only one of an argument that goes by its place: "cloud"
  std::string value;                 ///< what stands for it: "FILE"; empty for a flag
  std::string help;                  ///< a sentence
  std::string default_value;         ///< empty: none, or told in the help
  std::string group;                 ///< "Output"
  bool is_required = false;          ///< must be given
  bool is_repeatable = false;        ///< may be given more than once
  bool is_file = false;              ///< its value names a file
  std::vector<std::string> endings;  ///< of such files: ".ply"; empty for any
  std::vector<std::string> choices;  ///< all values that it takes; empty for others
};

struct CommandEntry {
  std::vector<std::string> path = {};  ///< "cloud2csg", "bench", "paper"
  std::string summary = {};            ///< one line
  std::string notes = {};              ///< what ends its help, without the examples
  std::string examples = {};           ///< lines to type
  std::vector<OptionEntry> arguments = {};
  std::vector<OptionEntry> options = {};
  std::vector<CommandEntry> commands = {};
};

/// All that the help shows; commands and options without a group are hidden.
[[nodiscard]] CommandEntry catalogue_of(CLI::App& program);

[[nodiscard]] OptionEntry entry_of(CLI::Option& option);

/// The command and those inside of it, outer ones first. They live as long as `program`.
[[nodiscard]] std::vector<const CommandEntry*> all_commands(const CommandEntry& program);

/// "cloud2csg bench paper"
[[nodiscard]] std::string path_text(const CommandEntry& command, const std::string& separator = " ");

/// The text with each occurrence of a part replaced.
[[nodiscard]] std::string replaced(std::string text, const std::string& part, const std::string& by);

}  // namespace cloud2csg::app
