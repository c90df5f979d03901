#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>
#include <vector>

#include "catalogue.hpp"
#include "cloud2csg/error.hpp"
#include "command.hpp"
#include "core/base/files.hpp"
#include "field_arguments.hpp"

namespace cloud2csg::app {
namespace {

/// A value, or the values of a list, as texts for the command line; empty for other contents.
std::vector<std::string> texts_of(const toml::node& value) {
  if (const auto* text = value.as_string()) return {text->get()};
  if (const auto* whole = value.as_integer()) return {std::to_string(whole->get())};
  // The shortest text that reads back as the same number.
  if (const auto* number = value.as_floating_point()) return {fmt::format("{}", number->get())};
  std::vector<std::string> texts;
  if (const toml::array* const list = value.as_array()) {
    for (const toml::node& item : *list) {
      if (!item.is_string() && !item.is_number()) return {};
      texts.push_back(texts_of(item).front());
    }
  }
  return texts;
}

/// A number if it reads back as the same text, else a quoted string.
std::string toml_of(const std::string& text) {
  try {
    const toml::table table = toml::parse("x = " + text);
    const toml::node& value = *table.get("x");
    if (table.size() == 1 && value.is_number() && texts_of(value).front() == text) return text;
  } catch (const toml::parse_error&) {
  }
  const toml::value<std::string> value(text);
  std::ostringstream quoted;
  quoted << toml::toml_formatter(value,
                                 toml::toml_formatter::default_flags & ~toml::format_flags::allow_literal_strings);
  return quoted.str();
}

/// The inverse of texts_of().
std::string toml_of(const std::vector<std::string>& texts) {
  std::vector<std::string> items;
  items.reserve(texts.size());
  for (const std::string& text : texts) items.push_back(toml_of(text));
  return items.size() == 1 ? items.front() : fmt::format("[{}]", fmt::join(items, ", "));
}

[[noreturn]] void refuse(const std::string& message) {
  throw CLI::ConfigError(message, CLI::ExitCodes::ConfigError);
}

/// The configurable option with this long name.
CLI::Option* option_named(CLI::App& command, const std::string& key) {
  CLI::Option* const option = command.get_option_no_throw("--" + key);
  return option != nullptr && option->get_configurable() ? option : nullptr;
}

/// The option that undoes a flag.
CLI::Option* opposite_of(CLI::App& command, const std::string& key) {
  return option_named(command, key.starts_with("no-") ? key.substr(3) : "no-" + key);
}

/// All subcommands, hidden ones included.
std::vector<CLI::App*> commands_in(CLI::App& outer) {
  return outer.get_subcommands([](CLI::App* /*any*/) { return true; });
}

/// The options allowed in a command's table, with `with_inner` also those of nested commands.
std::vector<std::string> option_names(CLI::App& command, bool with_inner) {
  std::vector<std::string> names;
  for (const CLI::Option* const option : command.get_options()) {
    if (option->get_configurable()) std::ranges::copy(option->get_lnames(), std::back_inserter(names));
  }
  if (!with_inner) return names;
  for (CLI::App* const inner : commands_in(command)) {
    std::ranges::copy(option_names(*inner, true), std::back_inserter(names));
  }
  return names;
}

/// Reads a file and applies its options to one command.
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
    read_table(*program, parsed());
  }

 private:
  [[nodiscard]] toml::table parsed() const {
    try {
      return toml::parse(read_text_file(file_), file_);
    } catch (const Error& error) {
      refuse(error.what());
    } catch (const toml::parse_error& error) {
      refuse(fmt::format("{}:{}: not valid TOML: {}", file_, error.source().begin.line, error.description()));
    }
  }

  [[noreturn]] void refuse_at(const toml::node& place, const std::string& message) const {
    refuse(fmt::format("{}:{}: {}", file_, place.source().begin.line, message));
  }

  [[noreturn]] void refuse_name(const std::string& what, const std::string& name, const toml::node& place,
                                const std::vector<std::string>& known) const {
    refuse_at(place, fmt::format("unknown {} '{}'{}", what, name, suggestion(name, known)));
  }

  /// Checks names in the tables of other commands, too. Before all tables, options of any command may stand.
  void read_table(CLI::App& command, const toml::table& table) {
    const bool is_top = command.get_parent() == nullptr;
    const std::vector<std::string> options = option_names(command, is_top);
    const std::vector<CLI::App*> inner = commands_in(command);
    std::vector<std::string> commands(inner.size());
    std::ranges::transform(inner, commands.begin(), [](const CLI::App* app) { return app->get_name(); });
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      if (value.is_table()) {
        const auto found = std::ranges::find(commands, name) - commands.begin();
        if (found == std::ssize(commands)) refuse_name("command", name, value, commands);
        read_table(*inner[static_cast<std::size_t>(found)], *value.as_table());
      } else {
        if (std::ranges::find(options, name) == options.end()) refuse_name("option", name, value, options);
        if (is_top || &command == &command_) set(name, value);
      }
    }
  }

  [[nodiscard]] bool is_overruled(CLI::Option* option) const {
    const std::set<CLI::Option*> excluded = option->get_excludes();
    return on_command_line_.contains(option) ||
           std::ranges::any_of(excluded, [this](CLI::Option* other) { return on_command_line_.contains(other); });
  }

  /// Does nothing where the command has no such option or the command line wins.
  void set(const std::string& name, const toml::node& value) {
    CLI::Option* option = option_named(command_, name);
    if (option == nullptr) return;
    std::vector<std::string> texts{"true"};
    if (takes_value(*option)) {
      texts = texts_of(value);
      if (texts.empty()) refuse_at(value, fmt::format("{}: expected text, a number, or a list of these", name));
    } else {
      if (!value.is_boolean()) refuse_at(value, fmt::format("{}: expected true or false", name));
      if (!*value.value<bool>()) option = opposite_of(command_, name);
    }
    if (option == nullptr || is_overruled(option)) return;
    try {
      option->add_result(texts);
      option->run_callback();
    } catch (const CLI::ParseError& error) {
      std::string message = reworded(error);
      if (message.starts_with(option->get_name())) message.replace(0, option->get_name().size(), name);
      refuse_at(value, message);
    }
  }

  CLI::App& command_;
  std::string file_;
  std::set<CLI::Option*> on_command_line_;
};

/// Parses a default of CLI11: "5", or "[5,6]" for a list.
std::vector<std::string> default_values(const std::string& text) {
  if (text.size() < 2 || text.front() != '[') return {text};
  return CLI::detail::split(text.substr(1, text.size() - 2), ',');
}

std::string flag_line(const CLI::Option& flag, const CLI::Option* opposite, const std::string& key) {
  if (flag.count() > 0) return key + " = true\n";
  if (opposite == nullptr || opposite->count() > 0) return key + " = false\n";
  const bool is_off = opposite->get_description().find("(default)") != std::string::npos;
  return fmt::format("# {} = {}\n", key, !is_off);
}

/// "key = value"; a comment where no value is given and the help describes the default.
std::string value_line(const CLI::Option& option, const std::string& key) {
  if (option.count() > 0) return fmt::format("{} = {}\n", key, toml_of(option.results()));
  if (option.get_default_str().empty()) return fmt::format("# {} = {}\n", key, option.get_type_name());
  // A file may set only one of two exclusive options.
  const char* const mark = option.get_excludes().empty() ? "" : "# ";
  return fmt::format("{}{} = {}\n", mark, key, toml_of(default_values(option.get_default_str())));
}

/// The options in force as a file for --config; options without a value are comments.
std::string config_text(CLI::App& command) {
  const std::string path = path_text(command, ".");
  std::string text = fmt::format(
      "# For --config. Options in lines that begin with # keep their defaults, see the text above each.\n\n[{}]\n",
      path.substr(path.find('.') + 1));
  std::string group;
  for (const CLI::Option* const option : options_of(command)) {
    if (option->get_lnames().empty() || !option->get_configurable()) continue;
    const std::string& key = option->get_lnames().front();
    const CLI::Option* const opposite = opposite_of(command, key);
    if (key.starts_with("no-") && opposite != nullptr) continue;  // the other option's line covers it
    if (option->get_group() != group) text += fmt::format("\n## {}\n", option->get_group());
    group = option->get_group();
    text += "# " + replaced(option->get_description(), "\n", "\n# ") + "\n";
    text += takes_value(*option) ? value_line(*option, key) : flag_line(*option, opposite, key);
  }
  return text;
}

}  // namespace

void add_config_options(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--config", [&command](const std::string& name) { ConfigReader(command, name).read(); },
          "Read options from this file, too; options on the command line take precedence")
      ->check(file_name())
      ->type_name("FILE.toml")
      ->configurable(false)
      ->group("Running");
  command
      .add_flag_callback(
          "--print-config", [&command] { throw PrintedConfig(config_text(command)); },
          "Print the options in force as a file for --config, and exit")
      ->configurable(false)
      ->group("Running");
}

}  // namespace cloud2csg::app
