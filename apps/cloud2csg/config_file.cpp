#include "config_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "cloud2csg/error.hpp"
#include "config_values.hpp"
#include "core/base/files.hpp"
#include "usage.hpp"
#include "values.hpp"

namespace cloud2csg::app {
namespace {

/// Names that a file cannot give: of what is done with the file, or instead of work.
constexpr std::array<std::string_view, 3> k_reserved{"config", "print-config", "help"};

/// The option of this long name that a file may give.
CLI::Option* option_named(CLI::App& command, const std::string& key) {
  if (std::find(k_reserved.begin(), k_reserved.end(), key) != k_reserved.end()) return nullptr;
  return command.get_option_no_throw("--" + key);
}

std::vector<CLI::App*> commands_in(CLI::App& outer) {
  return outer.get_subcommands([](CLI::App* /*any*/) { return true; });
}

bool any_command_has(CLI::App& outer, const std::string& key) {
  const std::vector<CLI::App*> inner = commands_in(outer);
  return option_named(outer, key) != nullptr ||
         std::any_of(inner.begin(), inner.end(), [&](CLI::App* command) { return any_command_has(*command, key); });
}

void add_names(CLI::App& outer, bool with_inner, std::vector<std::string>& names) {
  for (const CLI::Option* option : outer.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      if (option_named(outer, name) != nullptr) names.push_back(name);
    }
  }
  for (CLI::App* command : commands_in(outer)) {
    names.push_back(command->get_name());
    if (with_inner) add_names(*command, true, names);
  }
}

/// Goes through a file, and gives the options of one command what it says.
class ConfigReader {
 public:
  ConfigReader(CLI::App& command, std::string file) : command_(command), file_(std::move(file)) {
    for (CLI::Option* option : command.get_options()) {
      if (option->count() > 0) on_command_line_.insert(option);
    }
  }

  void read() {
    CLI::App* program = &command_;
    while (program->get_parent() != nullptr) program = program->get_parent();
    const toml::table table = parsed();
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      if (value.is_table()) {
        read_command(*program, name, *value.as_table());
      } else if (!any_command_has(*program, name)) {
        refuse_name(*program, true, name, value);
      } else if (option_named(command_, name) != nullptr) {
        set(name, value);
      }
    }
  }

 private:
  [[nodiscard]] toml::table parsed() const {
    std::string text;
    try {
      text = read_text_file(file_);
    } catch (const Error& error) {
      throw CLI::ConfigError(error.what(), CLI::ExitCodes::ConfigError);
    }
    try {
      return toml::parse(text, file_);
    } catch (const toml::parse_error& error) {
      throw CLI::ConfigError(fmt::format("{}:{}: no TOML: {}", file_, error.source().begin.line, error.description()),
                             CLI::ExitCodes::ConfigError);
    }
  }

  [[noreturn]] void refuse(const toml::node& place, const std::string& message) const {
    throw CLI::ConfigError(fmt::format("{}:{}: {}", file_, place.source().begin.line, message),
                           CLI::ExitCodes::ConfigError);
  }

  [[noreturn]] void refuse_name(CLI::App& outer, bool with_inner, const std::string& name,
                                const toml::node& place) const {
    std::vector<std::string> names;
    add_names(outer, with_inner, names);
    const std::string nearest = nearest_name(name, names);
    refuse(place, fmt::format("unknown {} '{}'{}", place.is_table() ? "command" : "option", name,
                              nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
  }

  /// Tables of other commands are checked for names that these do not have.
  void read_command(CLI::App& outer, const std::string& name, const toml::table& table) {
    const std::vector<CLI::App*> commands = commands_in(outer);
    const auto found = std::find_if(commands.begin(), commands.end(),
                                    [&name](const CLI::App* inner) { return inner->get_name() == name; });
    if (found == commands.end()) refuse_name(outer, false, name, table);
    CLI::App* const command = *found;
    for (const auto& [key, value] : table) {
      const std::string inner(key.str());
      if (value.is_table()) {
        read_command(*command, inner, *value.as_table());
      } else if (option_named(*command, inner) == nullptr) {
        refuse_name(*command, false, inner, value);
      } else if (command == &command_) {
        set(inner, value);
      }
    }
  }

  [[nodiscard]] bool is_overruled(CLI::Option* option) const {
    const std::set<CLI::Option*> excluded = option->get_excludes();
    return on_command_line_.contains(option) ||
           std::any_of(excluded.begin(), excluded.end(),
                       [this](CLI::Option* other) { return on_command_line_.contains(other); });
  }

  void set(const std::string& name, const toml::node& value) {
    CLI::Option* option = option_named(command_, name);
    std::vector<std::string> texts;
    if (option->get_expected_max() == 0) {
      if (!value.is_boolean()) refuse(value, fmt::format("{}: expected true or false", name));
      if (!*value.value<bool>()) option = opposite(name);
      texts = {"true"};
    } else {
      texts = texts_of(value);
      if (texts.empty()) refuse(value, fmt::format("{}: expected text, a number, or a list of these", name));
    }
    if (option == nullptr || is_overruled(option)) return;
    try {
      option->add_result(texts);
      option->run_callback();
    } catch (const CLI::ParseError& error) {
      refuse(value, replaced_name(reworded(error), option->get_name(), name));
    }
  }

  /// What false means for a flag: its counterpart, where it has one.
  [[nodiscard]] CLI::Option* opposite(const std::string& name) const {
    return option_named(command_, name.starts_with("no-") ? name.substr(3) : "no-" + name);
  }

  static std::string replaced_name(std::string message, const std::string& option, const std::string& key) {
    if (message.starts_with(option)) message.replace(0, option.size(), key);
    return message;
  }

  CLI::App& command_;
  std::string file_;
  std::set<CLI::Option*> on_command_line_;
};

}  // namespace

void add_config_options(CLI::App& command) {
  CLI::Option* const config = command.add_option_function<std::string>(
      "--config", [&command](const std::string& name) { apply_config(command, name); },
      "Options from this file as well; those of the command line win");
  config->check(file_name())->type_name("FILE.toml")->group("Running");
  command
      .add_flag_callback(
          "--print-config", [&command] { throw PrintedConfig(config_text(command)); },
          "Print the options in force as such a file, and exit")
      ->group("Running");
}

void apply_config(CLI::App& command, const std::string& file) {
  ConfigReader(command, file).read();
}

}  // namespace cloud2csg::app
