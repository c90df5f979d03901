#include "export/script_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

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
  // Names with an underline in front mean something in Python.
  return name.empty() || !is_letter(name[0]) ? "solid_" + name : name;
}

/// A character of a text in UTF-8.
struct Character {
  std::uint32_t code;
  std::string_view bytes;
};
constexpr std::uint32_t k_no_character = 0xFFFD;

/// The first character of a text that is not empty; a byte that begins none is one of code k_no_character.
Character first_character(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80U) return {.code = lead, .bytes = text.substr(0, 1)};
  const std::size_t length = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  constexpr std::array<std::uint32_t, 5> k_least{0, 0, 0x80, 0x800, 0x10000};
  const Character none{.code = k_no_character, .bytes = text.substr(0, 1)};
  if (lead < 0xC2U || lead > 0xF4U || text.size() < length) return none;
  std::uint32_t code = lead & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return none;
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < k_least[length] || code > 0x10FFFF || is_surrogate) return none;
  return {.code = code, .bytes = text.substr(0, length)};
}

std::vector<Character> characters_of(std::string_view text) {
  std::vector<Character> characters;
  characters.reserve(text.size());
  while (!text.empty()) {
    characters.push_back(first_character(text));
    text.remove_prefix(characters.back().bytes.size());
  }
  return characters;
}

/// Whether a character only takes its place in a line: no control, no end of a line, nothing that turns the direction
/// of reading, by which code can look like a comment.
bool is_plain_text(std::uint32_t code) {
  const auto between = [code](std::uint32_t first, std::uint32_t last) { return code >= first && code <= last; };
  return code >= 0x20 && !between(0x7F, 0x9F) && !between(0x2028, 0x202E) && !between(0x2066, 0x2069) &&
         code != k_no_character;
}

}  // namespace

std::string NumberFormat::operator()(double number) const {
  return std::abs(number) <= smallest_ ? "0" : fmt::format("{:.10g}", number);
}

std::string NumberFormat::operator()(const Eigen::Vector3d& vector) const {
  return fmt::format("{}, {}, {}", (*this)(vector.x()), (*this)(vector.y()), (*this)(vector.z()));
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
