#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace cloud2csg::test {

/// Whether one of the warnings has these words.
inline bool mentions(const std::vector<std::string>& warnings, std::string_view words) {
  return std::ranges::any_of(warnings,
                             [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
}

}  // namespace cloud2csg::test
