#include <fmt/format.h>
#include <fmt/ranges.h>

#include "completion.hpp"

namespace cloud2csg::app {
namespace {

constexpr const char* k_files = R"(# bash completion for cloud2csg

# Folders, and files with one of these endings; all files when there are none.
_cloud2csg_files() {
  local word=$1 file ending
  shift
  COMPREPLY=()
  compopt -o filenames 2>/dev/null
  while IFS= read -r file; do
    if [[ -d $file || $# -eq 0 ]]; then
      COMPREPLY+=("$file")
      continue
    fi
    for ending; do
      [[ ${file,,} == *"$ending" ]] && { COMPREPLY+=("$file"); break; }
    done
  done < <(compgen -f -- "$word")
}

_cloud2csg_words() {
  mapfile -t COMPREPLY < <(compgen -W "$2" -- "$1")
}

_cloud2csg() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} command=cloud2csg i
  # --option=value comes as three words.
  if [[ $word == = ]]; then
    word=
  elif [[ $previous == = && $COMP_CWORD -gt 1 ]]; then
    previous=${COMP_WORDS[COMP_CWORD-2]}
  fi
  for (( i = 1; i < COMP_CWORD; ++i )); do
    case "$command ${COMP_WORDS[i]}" in
)";

constexpr const char* k_end = R"(  esac
}

complete -F _cloud2csg cloud2csg
)";

std::string single_quoted(const std::string& text) {
  return quoted(text, R"('\'')");
}

std::string files_call(const std::vector<std::string>& endings) {
  return fmt::format("_cloud2csg_files \"$word\" {}", fmt::join(endings, " "));
}

std::string values_call(const OptionEntry& option) {
  if (option.is_file) return files_call(option.endings);
  return fmt::format("_cloud2csg_words \"$word\" {}", single_quoted(fmt::format("{}", fmt::join(option.choices, " "))));
}

std::string option_values(const CommandEntry& command) {
  std::string text;
  for (const OptionEntry& option : command.options) {
    if (option.value.empty()) continue;
    text += fmt::format("        {}) {}; return ;;\n", fmt::join(option.names, "|"), values_call(option));
  }
  return text.empty() ? "" : "      case \"$previous\" in\n" + text + "      esac\n";
}

std::string names_of(const CommandEntry& command) {
  std::vector<std::string> names;
  for (const OptionEntry& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return single_quoted(fmt::format("{}", fmt::join(names, " ")));
}

/// What stands at a place without a dash.
std::string plain_words(const CommandEntry& command) {
  std::vector<std::string> words;
  for (const CommandEntry& inner : command.commands) words.push_back(inner.path.back());
  for (const OptionEntry& argument : command.arguments) {
    if (argument.is_file) return files_call(argument_endings(command));
    words.insert(words.end(), argument.choices.begin(), argument.choices.end());
  }
  return fmt::format("_cloud2csg_words \"$word\" {}", single_quoted(fmt::format("{}", fmt::join(words, " "))));
}

std::string case_of(const CommandEntry& command) {
  return fmt::format(
      "    {})\n{}      if [[ $word == -* ]]; then\n        _cloud2csg_words \"$word\" {}\n      else\n        {}\n"
      "      fi ;;\n",
      single_quoted(path_text(command)), option_values(command), names_of(command), plain_words(command));
}

}  // namespace

std::string bash_completion(const CommandEntry& program) {
  std::vector<std::string> paths;
  std::string cases;
  for (const CommandEntry* command : all_commands(program)) {
    if (command->path.size() > 1) paths.push_back(single_quoted(path_text(*command)));
    cases += case_of(*command);
  }
  return fmt::format("{}      {}) command+=\" ${{COMP_WORDS[i]}}\" ;;\n    esac\n  done\n  case \"$command\" in\n{}{}",
                     k_files, fmt::join(paths, "|"), cases, k_end);
}

}  // namespace cloud2csg::app
