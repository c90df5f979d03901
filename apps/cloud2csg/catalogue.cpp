#include "catalogue.hpp"

#include <algorithm>
#include <iterator>

namespace cloud2csg::app {

std::vector<CLI::App*> commands_of(CLI::App& command) {
  return command.get_subcommands([](const CLI::App* inner) { return !inner->get_group().empty(); });
}

std::vector<CLI::App*> all_commands(CLI::App& command) {
  std::vector<CLI::App*> all{&command};
  for (CLI::App* const inner : commands_of(command)) std::ranges::copy(all_commands(*inner), std::back_inserter(all));
  return all;
}

std::vector<CLI::Option*> arguments_of(CLI::App& command) {
  return command.get_options(
      [](const CLI::Option* option) { return option->get_positional() && !option->get_group().empty(); });
}

std::vector<CLI::Option*> options_of(CLI::App& command) {
  const std::vector<CLI::Option*> options = command.get_options(
      [](const CLI::Option* option) { return !option->get_positional() && !option->get_group().empty(); });
  std::vector<CLI::Option*> sorted;
  for (const CLI::Option* const first : options) {
    if (std::ranges::find(sorted, first) != sorted.end()) continue;
    std::ranges::copy_if(options, std::back_inserter(sorted),
                         [first](const CLI::Option* other) { return other->get_group() == first->get_group(); });
  }
  return sorted;
}

std::vector<std::string> dashed_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool takes_value(const CLI::Option& option) {
  return option.get_expected_max() > 0;
}

std::string path_text(const CLI::App& command, const std::string& separator) {
  const CLI::App* const outer = command.get_parent();
  return (outer == nullptr ? std::string() : path_text(*outer, separator) + separator) + command.get_name();
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += by.size()) {
    text.replace(at, part.size(), by);
  }
  return text;
}

}  // namespace cloud2csg::app
