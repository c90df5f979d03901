#include "cloud2csg/error.hpp"

#include <algorithm>
#include <utility>

#include "core/base/text.hpp"

namespace cloud2csg {
namespace {

/// Limit of a message's bytes. The name of the file does not count.
constexpr std::size_t k_longest_message = 200;

/// Leaves out the middle of a long path: the path of a field may be as long as the file is deep.
std::string brief_place(const std::string& where) {
  constexpr std::size_t k_longest = 60;
  constexpr std::size_t k_end = 28;
  std::string visible = visible_text(where);
  if (visible.size() <= k_longest) return visible;
  return visible.substr(0, k_end) + "..." + visible.substr(visible.size() - k_end);
}

std::string one_line(const Error::Parts& parts) {
  const std::string where = brief_place(parts.where);
  const std::string end = parts.remedy.empty() ? "" : "; " + visible_text(parts.remedy);
  // `expected` may quote words of the file, which may have any length.
  const std::size_t taken = std::min(where.size() + end.size() + 7, k_longest_message);
  std::string line;
  for (const std::string& part :
       {visible_text(parts.file), where, visible_text(parts.expected, k_longest_message - taken)}) {
    if (part.empty()) continue;
    if (!line.empty()) line += ": ";
    line += part;
  }
  return line + end;
}

}  // namespace

Error invalid_option(std::string field, std::string expected, std::string remedy) {
  return Error({.where = std::move(field), .expected = std::move(expected), .remedy = std::move(remedy)});
}

Error::Error(Parts parts) : parts_(std::move(parts)), message_(one_line(parts_)) {}

}  // namespace cloud2csg
