#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

namespace cloud2csg {

/// A text of somebody else (an id, a description, the name of a file) for one line on a terminal: letters of UTF-8 stay
/// as they are; controls, ends of lines, what turns the direction of reading and bytes that are no UTF-8 are written as
/// \x1b or \u202e. What has been made so stays as it is. Longer than `longest` bytes, it ends in "...".
[[nodiscard]] std::string visible_text(std::string_view text,
                                       std::size_t longest = std::numeric_limits<std::size_t>::max());

/// Of words that messages quote from a file.
constexpr std::size_t k_longest_quote = 24;

}  // namespace cloud2csg
