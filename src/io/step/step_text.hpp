#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

/// Names in STEP files, as ISO 10303-21 wants them. The kernel has its own ways with quotes, line ends and characters
/// beyond ASCII, so it is given tokens, and the file gets the names in their place.
namespace cloud2csg::brep {

/// Stands for a name by its number: letters, digits and hyphens.
[[nodiscard]] std::string name_token(std::size_t number);

/// The text with each quoted token replaced by its name as a STEP string. A token of no name stays.
[[nodiscard]] std::string with_names(std::string_view text, std::span<const std::string> names);

/// In apostrophes, ASCII only: apostrophes and backslashes doubled, all that is not printable ASCII as \X\, \X2\ and
/// \X4\ directives. `utf8` is what it says; bytes that are not count as Latin 1.
[[nodiscard]] std::string step_string(std::string_view utf8);

}  // namespace cloud2csg::brep
