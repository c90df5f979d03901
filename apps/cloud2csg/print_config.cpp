#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "catalogue.hpp"
#include "config_file.hpp"
#include "config_values.hpp"

namespace cloud2csg::app {
namespace {

std::string table_name(const CLI::App& command) {
  const CLI::App* const outer = command.get_parent();
  const bool is_first = outer == nullptr || outer->get_parent() == nullptr;
  return (is_first ? "" : table_name(*outer) + ".") + command.get_name();
}

/// A default as CLI11 has it: "5", or "[5,6]" of a list.
std::vector<std::string> default_values(const std::string& text) {
  if (text.size() < 2 || text.front() != '[') return {text};
  return CLI::detail::split(text.substr(1, text.size() - 2), ',');
}

bool excludes_a_given_one(const CLI::Option& option) {
  const std::set<CLI::Option*> excluded = option.get_excludes();
  return std::any_of(excluded.begin(), excluded.end(), [](const CLI::Option* other) { return other->count() > 0; });
}

std::string commented(const std::string& text) {
  return "# " + replaced(text, "\n", "\n# ") + "\n";
}

std::string flag_line(const CLI::App& command, const CLI::Option& flag, const std::string& key) {
  const CLI::Option* const opposite = command.get_option_no_throw("--no-" + key);
  if (flag.count() > 0) return key + " = true\n";
  if (opposite == nullptr) return key + " = false\n";
  if (opposite->count() > 0) return key + " = false\n";
  const bool is_off = opposite->get_description().find("(default)") != std::string::npos;
  return fmt::format("# {} = {}\n", key, !is_off);
}

/// "key = value", or as a comment where nothing is given and the help says what happens then.
std::string value_line(const CLI::Option& option, const std::string& key) {
  if (option.count() > 0) return fmt::format("{} = {}\n", key, toml_of(option.results()));
  if (option.get_default_str().empty()) return fmt::format("# {} = {}\n", key, option.get_type_name());
  const std::string line = fmt::format("{} = {}\n", key, toml_of(default_values(option.get_default_str())));
  return (excludes_a_given_one(option) ? "# " : "") + line;
}

/// All options, those of a group together where its first is.
std::vector<const CLI::Option*> by_group(const CLI::App& command) {
  const std::vector<const CLI::Option*> options = command.get_options();
  std::vector<const CLI::Option*> sorted;
  for (const CLI::Option* first : options) {
    if (std::ranges::find(sorted, first) != sorted.end()) continue;
    std::ranges::copy_if(options, std::back_inserter(sorted),
                         [&](const CLI::Option* other) { return other->get_group() == first->get_group(); });
  }
  return sorted;
}

}  // namespace

std::string config_text(CLI::App& command) {
  std::string text =
      fmt::format("# For --config. What begins with # is as the text over it says.\n\n[{}]\n", table_name(command));
  std::string group;
  for (const CLI::Option* option : by_group(command)) {
    const std::vector<std::string>& names = option->get_lnames();
    if (names.empty() || option == command.get_help_ptr()) continue;
    const std::string& key = names.front();
    if (key == "config" || key == "print-config") continue;
    // Told by its counterpart.
    if (key.starts_with("no-") && command.get_option_no_throw("--" + key.substr(3)) != nullptr) continue;
    if (option->get_group() != group) text += fmt::format("\n## {}\n", option->get_group());
    group = option->get_group();
    text += commented(option->get_description());
    text += option->get_expected_max() == 0 ? flag_line(command, *option, key) : value_line(*option, key);
  }
  return text;
}

}  // namespace cloud2csg::app
