#include "config_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <sstream>

namespace cloud2csg::app {
namespace {

std::optional<std::string> text_of(const toml::node& value) {
  if (const auto* text = value.as_string()) return text->get();
  if (const auto* whole = value.as_integer()) return std::to_string(whole->get());
  // The shortest that is read as the same number.
  if (const auto* number = value.as_floating_point()) return fmt::format("{}", number->get());
  return std::nullopt;
}

std::string quoted(const std::string& text) {
  const toml::value<std::string> value(text);
  std::ostringstream toml;
  toml << toml::toml_formatter(value, toml::toml_formatter::default_flags & ~toml::format_flags::allow_literal_strings);
  return toml.str();
}

/// Whether it may stand without quotes.
bool is_bare(const std::string& text) {
  try {
    const toml::table table = toml::parse("x = " + text);
    return table.size() == 1 && texts_of(*table.get("x")) == std::vector<std::string>{text} &&
           !table.get("x")->is_array() && !table.get("x")->is_string();
  } catch (const toml::parse_error&) {
    return false;
  }
}

}  // namespace

std::vector<std::string> texts_of(const toml::node& value) {
  std::vector<std::string> texts;
  if (const toml::array* list = value.as_array()) {
    for (const toml::node& item : *list) {
      const std::optional<std::string> text = text_of(item);
      if (!text) return {};
      texts.push_back(*text);
    }
  } else if (const std::optional<std::string> text = text_of(value)) {
    texts.push_back(*text);
  }
  return texts;
}

std::string toml_of(const std::vector<std::string>& texts) {
  std::vector<std::string> items;
  items.reserve(texts.size());
  for (const std::string& text : texts) items.push_back(is_bare(text) ? text : quoted(text));
  return items.size() == 1 ? items.front() : fmt::format("[{}]", fmt::join(items, ", "));
}

}  // namespace cloud2csg::app
