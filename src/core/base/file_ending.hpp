#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

namespace cloud2csg {

/// ASCII letters of a text as small ones.
[[nodiscard]] inline std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

/// The ending of a file's name by which its format is known, with the dot, in small letters.
[[nodiscard]] inline std::string lower_ending(const std::filesystem::path& file) {
  return lower_case(file.extension().string());
}

}  // namespace cloud2csg
