#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <regex>
#include <set>

#include "catalogue.hpp"
#include "command.hpp"
#include "field_arguments.hpp"

namespace cloud2csg::app {
namespace {

constexpr const char* k_bash = R"(# bash completion for cloud2csg
_cloud2csg() {
  local word=${COMP_WORDS[COMP_CWORD]} program=${COMP_WORDS[0]/#\~/$HOME} before endings file lower
  [[ $word == = ]] && word=
  type -P -- "$program" >/dev/null || program=cloud2csg  # an alias
  mapfile -t COMPREPLY < <("$program" complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  COMPREPLY=("${COMPREPLY[@]%%$'\t'*}")
  [[ ${COMPREPLY[0]} == :files:* ]] || return 0
  IFS=: read -r _ _ before endings <<<"${COMPREPLY[0]}"
  COMPREPLY=()
  compopt -o filenames 2>/dev/null
  while IFS= read -r file; do
    lower=${file,,}
    [[ -d $file || -z $endings || " $endings " == *" ${lower/#*./.} "* ]] && COMPREPLY+=("$before$file")
  done < <(compgen -f -- "${word#"$before"}")
}
complete -F _cloud2csg cloud2csg
)";

constexpr const char* k_zsh = R"zsh(#compdef cloud2csg
_cloud2csg() {
  local -a lines parts
  lines=("${(@f)$(${~words[1]} complete "${(@Q)words[2,CURRENT-1]}" "$PREFIX" 2>/dev/null)}")
  if [[ $lines[1] == :files:* ]]; then
    parts=("${(@s.:.)lines[1]}")
    compset -P "$parts[3]"
    if [[ -n $parts[4] ]]; then _files -g "*.(#i)(${${parts[4]// /|}//.})"; else _files; fi
  elif [[ -n $lines[1] ]]; then
    lines=("${(@)lines/$'\t'/:}")
    _describe value lines
  fi
}
# Read by compinit the file is the function; read by `source` it defines it.
if [ "$funcstack[1]" = _cloud2csg ]; then _cloud2csg "$@"; else compdef _cloud2csg cloud2csg; fi
)zsh";

constexpr const char* k_fish = R"(# fish completion for cloud2csg
function __cloud2csg_complete
    set -l words (commandline -opc)
    set -l word (commandline -ct)
    set -l program (string replace -r '^~' "$HOME" -- $words[1])
    type -q $program; or return
    set -l lines ($program complete $words[2..-1] "$word" 2>/dev/null)
    if not string match -q ':files:*' -- "$lines[1]"
        test (count $lines) -gt 0; and string join \n -- $lines
        return
    end
    set -l parts (string split : -- $lines[1])
    set -l start (string sub -s (math (string length -- "$parts[3]") + 1) -- "$word")
    for file in $start*
        if test -d "$file"
            echo "$parts[3]$file/"
        else if test -z "$parts[4]"
            echo "$parts[3]$file"
        end
        for ending in (string split -n ' ' -- $parts[4])
            string match -qi -- "*$ending" "$file"; and not test -d "$file"; and echo "$parts[3]$file"
        end
    end
end
complete -c cloud2csg -f -a '(__cloud2csg_complete)'
)";

/// The endings of an option's files: those in its help, else that of its value name, "MODEL.json".
std::vector<std::string> endings_of(const CLI::Option& option) {
  static const std::regex k_ending(R"((^|[^.\w])(\.[A-Za-z][A-Za-z0-9]+)\b)");
  const std::string& help = option.get_description();
  std::vector<std::string> endings;
  for (std::sregex_iterator it(help.begin(), help.end(), k_ending), end; it != end; ++it) {
    const std::string ending = CLI::detail::to_lower((*it)[2]);
    if (std::ranges::find(endings, ending) == endings.end()) endings.push_back(ending);
  }
  const std::string value = option.get_type_name();
  const std::size_t dot = value.find('.');
  if (endings.empty() && dot != std::string::npos && value.find('|') == std::string::npos) {
    endings.push_back(value.substr(dot));
  }
  return endings;
}

/// The position of the cursor in the command line.
struct Place {
  CLI::App* command;
  CLI::Option* awaited = nullptr;  ///< option that expects a value next
  bool has_value = false;          ///< it has a value and may take more
  std::set<const CLI::Option*> given = {};
  std::size_t arguments = 0;  ///< number of arguments before the cursor

  /// Whether the word is a value of the awaited option. A second value never begins with a dash.
  [[nodiscard]] bool awaits(const std::string& word) const {
    return awaited != nullptr && !(has_value && word.starts_with('-'));
  }
};

/// An option with a value in the same word: "--output=part", "-opart".
struct OptionWord {
  CLI::Option* option;  ///< null without an option
  std::size_t value;    ///< start of the value; npos without one
};

OptionWord option_in(CLI::App& command, const std::string& word) {
  const bool is_long = word.starts_with("--");
  const std::size_t end = is_long ? word.find('=') : 2;
  const std::string name = word.substr(0, end);
  CLI::Option* const option = name.size() > 1 && name[0] == '-' ? command.get_option_no_throw(name) : nullptr;
  if (option == nullptr || end >= word.size()) return {.option = option, .value = std::string::npos};
  return {.option = option, .value = is_long ? end + 1 : end};
}

void pass(Place& place, const std::string& word) {
  if (place.awaits(word)) {
    if (word == "=") return;  // bash splits --option=value into three words
    place.has_value = true;
    if (!place.awaited->get_allow_extra_args()) place.awaited = nullptr;
    return;
  }
  place.awaited = nullptr;
  if (word.starts_with('-')) {
    const OptionWord found = option_in(*place.command, word);
    if (found.option == nullptr) return;
    place.given.insert(found.option);
    if (takes_value(*found.option) && found.value == std::string::npos) place.awaited = found.option;
    place.has_value = false;
    return;
  }
  const std::vector<CLI::App*> inner = commands_of(*place.command);
  const auto found = std::ranges::find(inner, word, [](const CLI::App* command) { return command->get_name(); });
  if (found == inner.end()) {
    ++place.arguments;
  } else {
    place = {.command = *found};
  }
}

std::string values_of(CLI::Option& option, const std::string& before, const std::string& start) {
  if (names_a_file(option)) return fmt::format(":files:{}:{}\n", before, fmt::join(endings_of(option), " "));
  std::string lines;
  for (const std::string& choice : choices_of(option)) {
    if (choice.starts_with(start)) lines += fmt::format("{}{}\n", before, choice);
  }
  return lines;
}

std::string line_of(const std::string& name, const std::string& help, const std::string& start) {
  return name.starts_with(start) ? fmt::format("{}\t{}\n", name, replaced(help, "\n", " ")) : "";
}

std::string options_at(const Place& place, const std::string& start) {
  std::string lines;
  for (const CLI::Option* const option : options_of(*place.command)) {
    if (place.given.contains(option) && option->get_items_expected_max() <= 1) continue;
    for (const std::string& name : dashed_names(*option)) lines += line_of(name, option->get_description(), start);
  }
  return lines;
}

}  // namespace

std::string completions(CLI::App& program, std::span<const std::string> words) {
  Place place{.command = &program};
  if (words.empty()) return {};
  for (const std::string& word : words.first(words.size() - 1)) pass(place, word);
  const std::string& last = words.back();
  if (place.awaits(last)) return values_of(*place.awaited, "", last == "=" ? "" : last);
  if (last.starts_with('-')) {
    const auto [option, value] = option_in(*place.command, last);
    if (option == nullptr || value == std::string::npos || !takes_value(*option)) return options_at(place, last);
    return values_of(*option, last.substr(0, value), last.substr(value));
  }
  std::string lines;
  for (const CLI::App* const inner : commands_of(*place.command)) {
    lines += line_of(inner->get_name(), inner->get_description(), last);
  }
  const std::vector<CLI::Option*> arguments = arguments_of(*place.command);
  return place.arguments < arguments.size() ? values_of(*arguments[place.arguments], "", last) : lines;
}

Command add_completion(CLI::App& program) {
  CLI::App* app = program.add_subcommand("completion", "Prints a shell script that completes commands and options");
  app->footer("Packages install these scripts where the shells look for them.\n\n" +
              example("  cloud2csg completion bash > ~/.local/share/bash-completion/completions/cloud2csg\n"
                      "  cloud2csg completion zsh > ~/.zfunc/_cloud2csg\n"
                      "  cloud2csg completion fish > ~/.config/fish/completions/cloud2csg.fish"));
  auto shell = std::make_shared<std::string>();
  app->add_option("shell", *shell, "Shell: bash, zsh or fish")
      ->check(one_of({"bash", "zsh", "fish"}))
      ->required()
      ->type_name("SHELL");
  return {.options = app, .run = [shell](const std::stop_token& /*stop*/) {
            fmt::print("{}", *shell == "bash" ? k_bash : *shell == "zsh" ? k_zsh : k_fish);
            return k_done;
          }};
}

}  // namespace cloud2csg::app
