#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What the text of an option's value must be. Each refuses anything else in one line that says what was expected and
/// what was found; those of CLI11 are terse, take not-a-number for a number and 010 for 8.
namespace cloud2csg::app {

/// A whole number in decimal digits.
[[nodiscard]] CLI::Validator whole_number(std::uint64_t least, std::uint64_t most);
/// The same, as large as 64 bits hold.
[[nodiscard]] CLI::Validator whole_number_from(std::uint64_t least);
/// A whole number in a range, or 0.
[[nodiscard]] CLI::Validator whole_number_or_0(std::uint64_t least, std::uint64_t most);

/// A finite number of 0 or more.
[[nodiscard]] CLI::Validator number_not_negative();
[[nodiscard]] CLI::Validator number_positive();
[[nodiscard]] CLI::Validator number_from_to(double least, double most);
/// A number from 0 to 1.
[[nodiscard]] CLI::Validator share();
[[nodiscard]] CLI::Validator one_of(std::vector<std::string> names);
/// A list of directions: see parse_directions().
[[nodiscard]] CLI::Validator directions();
/// Any text but an empty one.
[[nodiscard]] CLI::Validator file_name();

/// All values that an option takes, when one_of() checks it.
[[nodiscard]] std::vector<std::string> choices_of(CLI::Option& option);
/// Whether its value is checked by file_name().
[[nodiscard]] bool names_a_file(CLI::Option& option);

/// The directions of a list with commas: x, y, z, or three numbers each that are not all 0, as in "x,y,1,1,0". Absent
/// for any other text.
[[nodiscard]] std::optional<std::vector<Eigen::Vector3d>> parse_directions(const std::string& text);

}  // namespace cloud2csg::app
