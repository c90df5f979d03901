#include "core/base/text.hpp"

#include <fmt/format.h>

#include <iterator>

namespace cloud2csg {

std::string visible_text(std::string_view text, std::size_t longest) {
  std::string visible;
  while (!text.empty()) {
    const std::size_t before = visible.size();
    const std::optional<Utf8Character> first = first_character(text);
    const std::size_t bytes = first ? first->bytes : 1;
    if (first && is_plain_character(first->code)) {
      visible += text.substr(0, bytes);
    } else if (first && first->code > 0xFF) {
      fmt::format_to(std::back_inserter(visible), "\\u{:04x}", first->code);
    } else {
      const auto byte = static_cast<unsigned char>(text.front());
      fmt::format_to(std::back_inserter(visible), "\\x{:02x}", first ? first->code : byte);
    }
    if (visible.size() > longest) return visible.substr(0, before) + "...";
    text.remove_prefix(bytes);
  }
  return visible;
}

}  // namespace cloud2csg
