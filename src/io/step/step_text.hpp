#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

/// Names in STEP files per ISO 10303-21. The kernel mishandles quotes, line ends and characters beyond ASCII, so it
/// gets tokens, and the file gets the names in their place.
namespace cloud2csg::brep {

/// A token for a name, made of letters, digits and hyphens.
[[nodiscard]] std::string name_token(std::size_t number);

/// Replaces each quoted token by its name as a STEP string. A token without a name stays.
[[nodiscard]] std::string with_names(std::string_view text, std::span<const std::string> names);

/// A STEP string in ASCII: backslashes doubled, apostrophes and other characters as \X\, \X2\ and \X4\ directives.
/// Reads `utf8`, with invalid bytes as Latin 1.
[[nodiscard]] std::string step_string(std::string_view utf8);

}  // namespace cloud2csg::brep
