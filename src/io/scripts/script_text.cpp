#include "io/scripts/script_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "core/base/text.hpp"

namespace cloud2csg::script {
namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string identifier(const std::string& id) {
  std::string name;
  for (const char c : id) name += is_letter(c) || is_digit(c) ? c : '_';
  // In Python a leading underscore has a special meaning.
  return name.empty() || !is_letter(name[0]) ? "solid_" + name : name;
}

struct Character {
  std::uint32_t code;
  std::string_view bytes;
};
constexpr std::uint32_t k_no_character = 0xFFFD;

/// Represents an invalid byte by k_no_character.
std::vector<Character> characters_of(std::string_view text) {
  std::vector<Character> characters;
  characters.reserve(text.size());
  while (!text.empty()) {
    const Utf8Character first = first_character(text).value_or(Utf8Character{.code = k_no_character, .bytes = 1});
    characters.push_back({.code = first.code, .bytes = text.substr(0, first.bytes)});
    text.remove_prefix(first.bytes);
  }
  return characters;
}

bool is_plain_text(std::uint32_t code) {
  return is_plain_character(code) && code != k_no_character;
}

}  // namespace

std::string NumberFormat::operator()(double number) const {
  return std::abs(number) <= smallest_ ? "0" : fmt::format("{:.10g}", number);
}

std::string NumberFormat::operator()(const Eigen::Vector3d& vector) const {
  return fmt::format("{}, {}, {}", (*this)(vector.x()), (*this)(vector.y()), (*this)(vector.z()));
}

double degrees_of(double radians) {
  const double angle = radians * 180.0 / std::numbers::pi;
  const double rounded = std::round(angle);
  return std::abs(angle - rounded) < 1e-9 ? rounded + 0.0 : angle;
}

std::string UniqueNames::take(const std::string& wanted) {
  const std::string allowed = identifier(wanted);
  std::string name = allowed;
  for (int number = 2; !taken_.insert(name).second; ++number) name = fmt::format("{}_{}", allowed, number);
  return name;
}

std::vector<std::string> names_of(const PrimitiveSet& primitives, UniqueNames& names) {
  std::vector<std::string> given;
  given.reserve(primitives.size());
  for (const Primitive& primitive : primitives) given.push_back(names.take(primitive.id));
  return given;
}

std::string comment(std::string_view text, std::string_view prefix) {
  std::string lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    if (end > 0) {
      lines += prefix;
      for (const Character& character : characters_of(text.substr(0, end))) {
        lines += is_plain_text(character.code) ? character.bytes : std::string_view("?");
      }
      lines += '\n';
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string python_string(std::string_view text) {
  std::string quoted(1, '"');
  for (const Character& character : characters_of(text)) {
    const std::uint32_t code = character.code;
    if (code == '"' || code == '\\') {
      quoted += '\\';
      quoted += character.bytes;
    } else if (code >= 0x20 && code < 0x7F) {
      quoted += character.bytes;
    } else {
      quoted += code > 0xFFFF ? fmt::format("\\U{:08x}", code) : fmt::format("\\u{:04x}", code);
    }
  }
  return quoted + '"';
}

const std::set<std::string>& python_keywords() {
  static const std::set<std::string> keywords{"False",  "None",   "True",    "and",      "as",       "assert", "async",
                                              "await",  "break",  "class",   "continue", "def",      "del",    "elif",
                                              "else",   "except", "finally", "for",      "from",     "global", "if",
                                              "import", "in",     "is",      "lambda",   "nonlocal", "not",    "or",
                                              "pass",   "raise",  "return",  "try",      "while",    "with",   "yield"};
  return keywords;
}

}  // namespace cloud2csg::script
