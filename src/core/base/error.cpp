#include "cloud2csg/error.hpp"

#include <utility>

#include "core/base/visible_text.hpp"

namespace cloud2csg {
namespace {

std::string one_line(const Error::Parts& parts) {
  std::string line;
  for (const std::string* part : {&parts.file, &parts.where, &parts.expected}) {
    if (part->empty()) continue;
    if (!line.empty()) line += ": ";
    line += *part;
  }
  if (!parts.remedy.empty()) line += "; " + parts.remedy;
  return visible_text(line);
}

}  // namespace

Error::Error(Parts parts) : parts_(std::move(parts)), message_(one_line(parts_)) {}

}  // namespace cloud2csg
