#include "io/step/step_text.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <system_error>

#include "core/base/text.hpp"

namespace cloud2csg::brep {
namespace {

constexpr std::string_view k_token_start = "cloud2csg-name-";

/// The standard doubles apostrophes, but some readers, as OpenCASCADE, end the string at one before a bracket or comma.
bool stands_for_itself(std::uint32_t code) {
  return code >= 0x20 && code < 0x7F && code != '\'';
}

std::string escaped(std::uint32_t code) {
  if (code <= 0xFF) return fmt::format(R"(\X\{:02X})", code);
  if (code <= 0xFFFF) return fmt::format(R"(\X2\{:04X}\X0\)", code);
  return fmt::format(R"(\X4\{:08X}\X0\)", code);
}

}  // namespace

std::string name_token(std::size_t number) {
  return fmt::format("{}{}", k_token_start, number);
}

std::string step_string(std::string_view utf8) {
  std::string out = "'";
  while (!utf8.empty()) {
    // Treats invalid UTF-8 as Latin 1.
    const Utf8Character character =
        first_character(utf8).value_or(Utf8Character{.code = static_cast<unsigned char>(utf8[0]), .bytes = 1});
    utf8.remove_prefix(character.bytes);
    if (!stands_for_itself(character.code)) {
      out += escaped(character.code);
      continue;
    }
    const char plain = static_cast<char>(character.code);
    out.append(plain == '\\' ? 2 : 1, plain);
  }
  return out + "'";
}

std::string with_names(std::string_view text, std::span<const std::string> names) {
  std::string out;
  out.reserve(text.size());
  for (;;) {
    const std::size_t start = text.find(k_token_start);
    if (start == std::string_view::npos || start == 0) break;
    const std::string_view digits = text.substr(start + k_token_start.size());
    std::size_t number = names.size();
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const auto length = static_cast<std::size_t>(end - digits.data());
    const bool is_quoted = text[start - 1] == '\'' && length < digits.size() && digits[length] == '\'';
    if (error != std::errc() || !is_quoted || number >= names.size()) {
      out += text.substr(0, start + k_token_start.size());
      text = digits;
      continue;
    }
    out += text.substr(0, start - 1);
    out += step_string(names[number]);
    text = digits.substr(length + 1);
  }
  return out += text;
}

}  // namespace cloud2csg::brep
