#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace cloud2csg {

struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};

/// The first character. Absent where the first byte begins no valid UTF-8 character: cut off, overlong, beyond Unicode
/// or a surrogate. Precondition: the text is not empty.
[[nodiscard]] inline std::optional<Utf8Character> first_character(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80U) return Utf8Character{.code = lead, .bytes = 1};
  const std::size_t bytes = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC2U || lead > 0xF4U || text.size() < bytes) return std::nullopt;
  std::uint32_t code = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return std::nullopt;
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> k_least{0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < k_least[bytes] || code > 0x10FFFF || is_surrogate) return std::nullopt;
  return Utf8Character{.code = code, .bytes = bytes};
}

/// Whether a character only takes its place in a line: no control, line end or change of direction (Trojan Source).
[[nodiscard]] inline bool is_plain_character(std::uint32_t code) {
  const auto between = [code](std::uint32_t first, std::uint32_t last) { return code >= first && code <= last; };
  return code >= 0x20 && !between(0x7F, 0x9F) && code != 0x61C && !between(0x200E, 0x200F) &&
         !between(0x2028, 0x202E) && !between(0x2066, 0x2069);
}

/// The text with its ASCII letters in lower case.
[[nodiscard]] inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

/// Foreign text (an id, a description, a file name) as one line for a terminal. Controls, line ends, changes of reading
/// direction and invalid UTF-8 become \x1b or \u202e. Idempotent. Longer than `longest` bytes, it ends in "...".
[[nodiscard]] std::string visible_text(std::string_view text,
                                       std::size_t longest = std::numeric_limits<std::size_t>::max());

/// Limit of bytes for words that messages quote from a file.
constexpr std::size_t k_longest_quote = 24;

}  // namespace cloud2csg
