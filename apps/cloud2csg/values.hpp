#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"

/// What the text of an option's value must be. Each refuses anything else in one line that says what was expected and
/// what was found; those of CLI11 are terse, take not-a-number for a number and 010 for 8.
namespace cloud2csg::app {

/// A number in a range, in decimal digits; brings it into the form that CLI11, which takes leading zeros for the mark
/// of octal numbers, reads as the same.
template <typename Number>
[[nodiscard]] CLI::Validator number_in(const OptionRange& range);
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

/// The number, when that is all there is in a text and it fits.
template <typename Number>
[[nodiscard]] std::optional<Number> parsed(const std::string& text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  if (failure != std::errc{} || stop != end) return std::nullopt;
  return value;
}

// How values of options structs are read: a trait a type, since each is checked, read and named by its own rules.

/// Of types that the command line does not know.
template <typename Value>
struct ValueReader {};
template <typename Value>
concept IsReadable = requires {
  ValueReader<Value>::k_type;
};

template <typename Number>
requires std::is_arithmetic_v<Number>
struct ValueReader<Number> {
  static constexpr std::string_view k_type = std::is_integral_v<Number> ? "N" : "X";
  static void check(CLI::Option& option, const OptionRange& range) { option.transform(number_in<Number>(range)); }
  static void read(const std::vector<std::string>& texts, Number& value) {
    value = parsed<Number>(texts.front()).value();
  }
};

template <HasNames Enum>
struct ValueReader<Enum> {
  static constexpr std::string_view k_type = "NAME";
  static std::vector<std::string> names() {
    std::vector<std::string> names;
    for (const EnumName<Enum>& known : names_of(Enum{})) names.emplace_back(known.name);
    return names;
  }
  static void check(CLI::Option& option, const OptionRange& /*range*/) { option.check(one_of(names())); }
  static void read(const std::vector<std::string>& texts, Enum& value) {
    value = enum_named<Enum>(texts.front()).value();
  }
};

template <typename Value>
struct ValueReader<std::optional<Value>> : ValueReader<Value> {
  static void read(const std::vector<std::string>& texts, std::optional<Value>& value) {
    ValueReader<Value>::read(texts, value.emplace());
  }
};

/// Lists of lengths stand in one word, with commas; of others each is a word.
template <typename Value>
struct ValueReader<std::vector<Value>> : ValueReader<Value> {
  static void check(CLI::Option& option, const OptionRange& range) {
    ValueReader<Value>::check(option, range);
    constexpr bool k_in_one_word = std::is_floating_point_v<Value>;
    option.expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(!k_in_one_word);
    if (k_in_one_word) option.delimiter(',');
  }
  static void read(const std::vector<std::string>& texts, std::vector<Value>& values) {
    values.clear();
    for (const std::string& text : texts) ValueReader<Value>::read({text}, values.emplace_back());
  }
};

/// Of which several may stand in a word: see parse_directions().
template <>
struct ValueReader<std::vector<Eigen::Vector3d>> {
  static constexpr std::string_view k_type = "A,A...";
  static void check(CLI::Option& option, const OptionRange& range);
  static void read(const std::vector<std::string>& texts, std::vector<Eigen::Vector3d>& values);
};

}  // namespace cloud2csg::app
