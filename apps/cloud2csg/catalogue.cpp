#include "catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>

#include "values.hpp"

namespace cloud2csg::app {
namespace {

constexpr const char* k_example = "Example:\n";

/// The endings of files that a text speaks of, in its order.
std::vector<std::string> endings_in(const std::string& text) {
  static const std::regex k_ending(R"((^|[^.\w])(\.[A-Za-z][A-Za-z0-9]+)\b)");
  std::vector<std::string> endings;
  for (std::sregex_iterator it(text.begin(), text.end(), k_ending), end; it != end; ++it) {
    const std::string ending = (*it)[2];
    if (std::find(endings.begin(), endings.end(), ending) == endings.end()) endings.push_back(ending);
  }
  return endings;
}

/// "MODEL.json" says it all; else the help lists them.
std::vector<std::string> endings_of(const std::string& value, const std::string& help) {
  std::vector<std::string> endings = endings_in(help);
  const std::size_t dot = value.find('.');
  if (endings.empty() && dot != std::string::npos && value.find('|') == std::string::npos) {
    endings.push_back(value.substr(dot));
  }
  return endings;
}

void add_footer(CommandEntry& command, const CLI::App& app) {
  const std::string footer = app.get_footer();
  const std::size_t place = footer.find(k_example);
  command.notes = footer.substr(0, place);
  while (command.notes.ends_with('\n')) command.notes.pop_back();
  if (place != std::string::npos) command.examples = footer.substr(place + std::string(k_example).size());
}

CommandEntry entry_of(CLI::App& app, std::vector<std::string> path) {
  path.push_back(app.get_name());
  CommandEntry command{.path = std::move(path), .summary = app.get_description()};
  add_footer(command, app);
  for (CLI::Option* option : app.get_options([](const CLI::Option* shown) { return !shown->get_group().empty(); })) {
    (option->get_positional() ? command.arguments : command.options).push_back(app::entry_of(*option));
  }
  for (CLI::App* inner : app.get_subcommands([](CLI::App* shown) { return !shown->get_group().empty(); })) {
    command.commands.push_back(entry_of(*inner, command.path));
  }
  return command;
}

}  // namespace

OptionEntry entry_of(CLI::Option& option) {
  OptionEntry entry{.names = {},
                    .value = option.get_expected_max() == 0 ? "" : option.get_type_name(),
                    .help = option.get_description(),
                    .default_value = option.get_default_str(),
                    .group = option.get_group(),
                    .is_required = option.get_required(),
                    .is_repeatable = option.get_items_expected_max() > 1,
                    .is_file = names_a_file(option),
                    .endings = {},
                    .choices = choices_of(option)};
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  if (entry.names.empty()) entry.names.push_back(option.get_name());
  if (entry.is_file) entry.endings = endings_of(entry.value, entry.help);
  return entry;
}

CommandEntry catalogue_of(CLI::App& program) {
  return entry_of(program, {});
}

std::vector<const CommandEntry*> all_commands(const CommandEntry& program) {
  std::vector<const CommandEntry*> all{&program};
  for (const CommandEntry& command : program.commands) {
    const std::vector<const CommandEntry*> inner = all_commands(command);
    all.insert(all.end(), inner.begin(), inner.end());
  }
  return all;
}

std::string path_text(const CommandEntry& command, const std::string& separator) {
  return fmt::format("{}", fmt::join(command.path, separator));
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += by.size()) {
    text.replace(at, part.size(), by);
  }
  return text;
}

}  // namespace cloud2csg::app
