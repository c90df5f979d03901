#include <fmt/format.h>
#include <fmt/ranges.h>

#include "completion.hpp"

namespace cloud2csg::app {
namespace {

std::string zsh_word(const std::string& text) {
  return quoted(text, R"('\'')");
}

/// Text within the brackets or between the colons of _arguments.
std::string plain(std::string text) {
  for (const char* const special : {"\\", "[", "]", ":"}) text = replaced(text, special, std::string("\\") + special);
  return replaced(std::move(text), "\n", " ");
}

/// The `action` of _arguments for a value.
std::string action_of(const OptionEntry& option, const std::vector<std::string>& endings) {
  if (option.is_file && endings.empty()) return "_files";
  if (option.is_file) {
    std::vector<std::string> bare;
    bare.reserve(endings.size());
    for (const std::string& ending : endings) bare.push_back(ending.substr(1));
    return fmt::format("_files -g \"*.(#i)({})\"", fmt::join(bare, "|"));
  }
  return option.choices.empty() ? " " : fmt::format("({})", fmt::join(option.choices, " "));
}

std::string option_spec(const OptionEntry& option) {
  const bool has_value = !option.value.empty();
  std::string names;
  std::string all;
  for (const std::string& name : option.names) {
    all += (all.empty() ? "" : " ") + name;
    names += (names.empty() ? "" : ",") + name + (has_value ? (name.starts_with("--") ? "=" : "+") : "");
  }
  if (option.names.size() > 1) names = "{" + names + "}";
  const std::string before = option.is_repeatable ? "'*'" : option.names.size() > 1 ? zsh_word("(" + all + ")") : "";
  std::string after = "[" + plain(option.help) + "]";
  if (has_value) after += ":" + plain(option.value) + ":" + action_of(option, option.endings);
  return before + names + zsh_word(after);
}

std::string function_name(const CommandEntry& command) {
  return "_" + path_text(command, "_");
}

/// Of a command with commands inside: which of them, and what goes on in there.
std::string inner_text(const CommandEntry& command) {
  std::string names;
  std::string calls;
  for (const CommandEntry& inner : command.commands) {
    names += fmt::format("        {}\n", zsh_word(inner.path.back() + ":" + plain(inner.summary)));
    calls += fmt::format("        {}) {} ;;\n", inner.path.back(), function_name(inner));
  }
  return fmt::format(
      "  case $state in\n    command)\n      local -a commands=(\n{}      )\n      _describe -t commands command "
      "commands "
      ";;\n    arguments)\n      case $words[1] in\n{}      esac ;;\n  esac\n",
      names, calls);
}

std::string function_of(const CommandEntry& command) {
  std::string specs;
  for (const OptionEntry& option : command.options) specs += " \\\n    " + option_spec(option);
  const bool is_outer = !command.commands.empty();
  if (is_outer) specs += " \\\n    '1:command:->command' \\\n    '*::argument:->arguments'";
  for (const OptionEntry& argument : command.arguments) {
    specs += " \\\n    " + zsh_word(fmt::format("{}:{}:{}", argument.is_repeatable ? "*" : "", plain(argument.value),
                                                action_of(argument, argument.endings)));
  }
  return fmt::format(
      "{}() {{\n  local curcontext=\"$curcontext\" state state_descr line\n  typeset -A opt_args\n"
      "  _arguments -s{}{}\n{}}}\n\n",
      function_name(command), is_outer ? " -C" : "", specs, is_outer ? inner_text(command) : "");
}

}  // namespace

std::string zsh_completion(const CommandEntry& program) {
  std::string functions;
  for (const CommandEntry* command : all_commands(program)) functions += function_of(*command);
  return "#compdef cloud2csg\n\n" + functions +
         "# Read by compinit the file is the function; read by `source` it defines it.\n"
         "if [ \"$funcstack[1]\" = _cloud2csg ]; then _cloud2csg \"$@\"; else compdef _cloud2csg cloud2csg; fi\n";
}

}  // namespace cloud2csg::app
