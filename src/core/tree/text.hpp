#pragma once

#include <string_view>

/// What the writer and the reader of a tree's text form agree on.
namespace cloud2csg {

constexpr std::string_view k_empty_word = "empty";
constexpr std::string_view k_full_word = "full";

/// Whether an id may hold this byte without quotes. Every byte of UTF-8 beyond ASCII may.
[[nodiscard]] bool is_name_character(char c);

}  // namespace cloud2csg
