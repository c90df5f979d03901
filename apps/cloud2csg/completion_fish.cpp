#include <fmt/format.h>
#include <fmt/ranges.h>

#include "completion.hpp"

namespace cloud2csg::app {
namespace {

constexpr const char* k_begin = R"(# fish completion for cloud2csg

# Whether the command line is in this command.
function __cloud2csg_in
    set -l at cloud2csg
    for word in (commandline -opc)[2..]
        switch "$at $word"
            case )";

constexpr const char* k_functions = R"(
                set at "$at $word"
        end
    end
    test "$at" = "$argv[1]"
end

# Folders, and files with one of these endings; all files when there are none.
function __cloud2csg_files
    for file in (commandline -ct)*
        if test -d "$file"
            echo "$file/"
        else if test (count $argv) -eq 0
            echo "$file"
        end
        for ending in $argv
            string match -qi -- "*$ending" "$file"; and not test -d "$file"; and echo "$file"
        end
    end
end

complete -c cloud2csg -f
)";

std::string fish_word(const std::string& text) {
  return quoted(replaced(text, "\\", "\\\\"), "\\'");
}

std::string begin_of(const CommandEntry& command) {
  return fmt::format("complete -c cloud2csg -n {}", fish_word("__cloud2csg_in " + fish_word(path_text(command))));
}

/// What completes a value: `-a ...`.
std::string values_of(const OptionEntry& option, const std::vector<std::string>& endings) {
  if (option.is_file) return fmt::format(" -a '(__cloud2csg_files {})'", fmt::join(endings, " "));
  if (option.choices.empty()) return "";
  return fmt::format(" -a {}", fish_word(fmt::format("{}", fmt::join(option.choices, " "))));
}

std::string option_line(const CommandEntry& command, const OptionEntry& option) {
  std::string line = begin_of(command);
  for (const std::string& name : option.names) {
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (!option.value.empty()) line += " -x" + values_of(option, option.endings);
  return fmt::format("{} -d {}\n", line, fish_word(option.help));
}

}  // namespace

std::string fish_completion(const CommandEntry& program) {
  std::vector<std::string> paths;
  std::string lines;
  for (const CommandEntry* command : all_commands(program)) {
    if (command->path.size() > 1) paths.push_back(fish_word(path_text(*command)));
    for (const CommandEntry& inner : command->commands) {
      lines += fmt::format("{} -a {} -d {}\n", begin_of(*command), inner.path.back(), fish_word(inner.summary));
    }
    for (const OptionEntry& argument : command->arguments) {
      lines += begin_of(*command) + values_of(argument, argument_endings(*command)) + "\n";
      if (argument.is_file) break;  // one line for all places
    }
    for (const OptionEntry& option : command->options) lines += option_line(*command, option);
  }
  return fmt::format("{}{}{}{}", k_begin, fmt::join(paths, " "), k_functions, lines);
}

}  // namespace cloud2csg::app
