#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"

/// Each options struct has a table beside it, the source of validation, command line, configuration and Python classes.
///
///     void option_table(OptionsOf<GaOptions>, auto&& field) {
///       using O = GaOptions;
///       field(&O::population, "population", "Number of trees in a generation", at_least(2));
///       ...
namespace cloud2csg {

/// The allowed numbers of a field, always finite.
struct OptionRange {
  double least = std::numeric_limits<double>::lowest();
  double most = std::numeric_limits<double>::max();
  bool is_above = false;    ///< `least` itself is excluded
  bool takes_zero = false;  ///< 0 is allowed, too

  [[nodiscard]] constexpr bool holds(double value) const {
    return (takes_zero && value == 0) || ((is_above ? value > least : value >= least) && value <= most);
  }
};
constexpr OptionRange at_least(double least) {
  return {.least = least};
}
constexpr OptionRange at_most(double most) {
  return {.most = most};
}
constexpr OptionRange above(double least) {
  return {.least = least, .is_above = true};
}
constexpr OptionRange above_to(double least, double most) {
  return {.least = least, .most = most, .is_above = true};
}
constexpr OptionRange from_to(double least, double most) {
  return {.least = least, .most = most};
}
inline constexpr OptionRange k_share = from_to(0, 1);

/// OptionDetails::option of a field without an option on the command line.
inline constexpr std::string_view k_no_option = "-";

struct OptionDetails {
  OptionRange range = {};        ///< allowed numbers, list elements or vector lengths
  std::string_view absent = {};  ///< meaning of an absent value
  std::string_view unit = {};    ///< placeholder for the value in the command line's help: "DEG"
  std::string_view option = {};  ///< long name on the command line, if not derived from the field: see option_name()
  char letter = 0;
  std::string_view opposite = {};   ///< bool: the option that sets it to false
  std::string_view otherwise = {};  ///< help of the opposite option
  std::string_view group = {};      ///< group in the command line's help; empty: the struct's group
};

/// Describes a field. Texts name other fields in `backticks`, which the command line replaces by its options.
struct OptionField : OptionDetails {
  std::string_view name;  ///< as in C++, Python, JSON and messages
  std::string_view text;  ///< sentences; the command line's help shows the first

  constexpr OptionField(std::string_view its_name, std::string_view its_text, const OptionDetails& details = {})
      : OptionDetails(details), name(its_name), text(its_text) {}
};

/// For fields without an option on the command line.
inline constexpr OptionDetails k_library{.option = k_no_option};

inline constexpr OptionField k_seed{
    "seed", "Random seed: the same seed gives the same result, for any number of threads", {.unit = "S"}};
/// The entry of a seed in nested structs; the outermost struct has the seed for all.
inline constexpr OptionField k_inner_seed{k_seed.name, k_seed.text, k_library};

/// Selects the table of a struct.
template <typename Options>
using OptionsOf = std::type_identity<Options>;

/// The `field` argument of a table: passes each entry to `visit(member, field)`.
template <typename Visit>
struct FieldVisitor {
  Visit visit;

  void operator()(auto member, const OptionField& field) const { visit(member, field); }
  void operator()(auto member, std::string_view name, std::string_view text, const OptionDetails& details = {}) const {
    visit(member, OptionField(name, text, details));
  }
  void operator()(auto member, std::string_view name, std::string_view text, const OptionRange& range,
                  OptionDetails details = {}) const {
    details.range = range;
    visit(member, OptionField(name, text, details));
  }
};

template <typename Options>
concept HasOptionTable = requires(FieldVisitor<void (*)()> field) {
  option_table(OptionsOf<Options>{}, field);
};

/// Calls `visit(member pointer, OptionField)` for each entry, in the order of the table.
template <HasOptionTable Options, typename Visit>
void for_each_field(Visit visit) {
  option_table(OptionsOf<Options>{}, FieldVisitor<Visit>{std::move(visit)});
}

/// Two fields that are in range one by one, but not together.
struct OptionConflict {
  std::string field;
  std::string expected;  ///< "expected no more than `most_size`, found 3 and 2"
};

/// An enumeration whose values have names: `names_of(Strategy)` gives a list of EnumName.
template <typename Enum>
struct EnumName {
  std::string_view name;
  Enum value;
};
template <typename Enum>
concept HasNames = std::is_enum_v<Enum> && requires(Enum value) {
  names_of(value);
};
template <HasNames Enum>
[[nodiscard]] constexpr std::optional<Enum> enum_named(std::string_view name) {
  for (const EnumName<Enum>& known : names_of(Enum{})) {
    if (known.name == name) return known.value;
  }
  return std::nullopt;
}
template <HasNames Enum>
[[nodiscard]] constexpr std::string_view to_string(Enum value) {
  for (const EnumName<Enum>& known : names_of(value)) {
    if (known.value == value) return known.name;
  }
  return {};
}

/// The range in words: "2 or more", "a number from 0 to 1".
[[nodiscard]] std::string range_text(const OptionRange& range, bool is_whole);
/// "expected 2 or more, found 1"; empty for a value in range.
[[nodiscard]] std::string range_fault(const OptionRange& range, double value, bool is_whole);

/// The option name of a field without dashes: the table's name, or the field's without its unit ("angle-tolerance" for
/// "angle_tolerance_deg"). Empty where the command line has none.
[[nodiscard]] std::string option_name(const OptionField& field);

/// The shortest text that reads back as the same number.
[[nodiscard]] std::string value_text(double value);
[[nodiscard]] std::string value_text(const Eigen::Vector3d& value);
/// Numbers, names of enumerations, texts, and lists of these; empty for absent values and other types.
template <typename Value>
[[nodiscard]] std::string value_text(const Value& value) {
  if constexpr (std::is_integral_v<Value>) {
    return std::to_string(value);
  } else if constexpr (HasNames<Value>) {
    return std::string(to_string(value));
  } else if constexpr (std::is_convertible_v<Value, std::string>) {
    return value;
  } else {
    return {};
  }
}
template <typename Value>
[[nodiscard]] std::string value_text(const std::optional<Value>& value) {
  return value ? value_text(*value) : std::string();
}
template <typename Value>
[[nodiscard]] std::string value_text(const std::vector<Value>& values, const char* between = ", ") {
  std::string text;
  for (const Value& value : values) text += (text.empty() ? "" : between) + value_text(value);
  return text;
}

template <HasOptionTable Options>
void validate(const Options& options, const std::string& path = {});

namespace options_detail {

void check_number(const std::string& path, const OptionRange& range, double value, bool is_whole);

template <typename Value>
void check(const std::string& path, const OptionRange& range, const Value& value) {
  if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
    check_number(path, range, static_cast<double>(value), std::is_integral_v<Value>);
  } else if constexpr (HasOptionTable<Value>) {
    validate(value, path + ".");
  }
}
inline void check(const std::string& path, const OptionRange& range, const Eigen::Vector3d& value) {
  check_number(path, range, value.norm(), false);
}
template <typename Value>
void check(const std::string& path, const OptionRange& range, const std::optional<Value>& value) {
  if (value) check(path, range, *value);
}
template <typename Value>
void check(const std::string& path, const OptionRange& range, const std::vector<Value>& values) {
  for (const Value& value : values) check(path, range, value);
}

}  // namespace options_detail

/// Checks all fields, nested structs included, against their ranges, then against each other by
/// `std::optional<OptionConflict> conflict_in(const Options&)`, where the struct has one. Error messages put `path`
/// before field names. @throws Error naming the field that is out of range.
template <HasOptionTable Options>
void validate(const Options& options, const std::string& path) {
  for_each_field<Options>([&](auto member, const OptionField& field) {
    options_detail::check(path + std::string(field.name), field.range, options.*member);
  });
  if constexpr (requires { conflict_in(options); }) {
    if (std::optional<OptionConflict> conflict = conflict_in(options)) {
      throw invalid_option(path + conflict->field, std::move(conflict->expected));
    }
  }
}

}  // namespace cloud2csg
