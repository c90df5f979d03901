#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

/// What the text of an option's value must be. Each refuses anything else in one line that says what was expected and
/// what was found; those of CLI11 are terse, take not-a-number for a number and 010 for 8.
namespace cloud2csg::app {

/// A whole number in decimal digits.
[[nodiscard]] CLI::Validator whole_number(std::uint64_t least, std::uint64_t most);
/// The same, as large as 64 bits hold.
[[nodiscard]] CLI::Validator whole_number_from(std::uint64_t least);

/// A finite number of 0 or more.
[[nodiscard]] CLI::Validator number_not_negative();
[[nodiscard]] CLI::Validator number_positive();
/// A number from 0 to 1.
[[nodiscard]] CLI::Validator share();
[[nodiscard]] CLI::Validator one_of(std::vector<std::string> names);
/// Any text but an empty one.
[[nodiscard]] CLI::Validator file_name();

/// All values that an option takes, when one_of() checks it.
[[nodiscard]] std::vector<std::string> choices_of(CLI::Option& option);
/// Whether its value is checked by file_name().
[[nodiscard]] bool names_a_file(CLI::Option& option);

}  // namespace cloud2csg::app
