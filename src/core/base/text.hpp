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

/// The code of a text's first character.
struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};

/// Absent where the first byte begins no character of UTF-8: one that is cut off, longer than it need be, beyond
/// Unicode or half of a pair. Precondition: the text is not empty.
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

/// Whether a character only takes its place in a line: no control, no end of a line, nothing that turns the direction
/// of reading, by which code can look like a comment.
[[nodiscard]] inline bool is_plain_character(std::uint32_t code) {
  const auto between = [code](std::uint32_t first, std::uint32_t last) { return code >= first && code <= last; };
  return code >= 0x20 && !between(0x7F, 0x9F) && code != 0x61C && !between(0x200E, 0x200F) &&
         !between(0x2028, 0x202E) && !between(0x2066, 0x2069);
}

/// ASCII letters of a text as small ones.
[[nodiscard]] inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

/// A text of somebody else (an id, a description, the name of a file) for one line on a terminal: letters of UTF-8 stay
/// as they are; controls, ends of lines, what turns the direction of reading and bytes that are no UTF-8 are written as
/// \x1b or \u202e. What has been made so stays as it is. Longer than `longest` bytes, it ends in "...".
[[nodiscard]] std::string visible_text(std::string_view text,
                                       std::size_t longest = std::numeric_limits<std::size_t>::max());

/// Of words that messages quote from a file.
constexpr std::size_t k_longest_quote = 24;

}  // namespace cloud2csg
