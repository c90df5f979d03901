#include "values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

namespace cloud2csg::app {
namespace {

// Names of validators, by which they are known again.
constexpr const char* k_choices = "one of ";
constexpr const char* k_file = "file";

/// CLI11 does not tell how many an option has, and throws after the last.
std::vector<std::string> validator_names(CLI::Option& option) {
  std::vector<std::string> names;
  try {
    for (int i = 0;; ++i) names.push_back(option.get_validator(i)->get_name());
  } catch (const CLI::OptionNotFound&) {
    return names;
  }
}

/// The text's number, when that is all there is in it and it fits.
template <typename Number>
std::optional<Number> parsed(const std::string& text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  if (failure != std::errc{} || stop != end) return std::nullopt;
  return value;
}

std::string refusal(const std::string& expected, const std::string& found) {
  return fmt::format("expected {}, found '{}'", expected, found);
}

/// `is_right` judges a text, and may bring it into the form that CLI11 reads.
template <typename IsRight>
CLI::Validator validator(std::string expected, IsRight is_right) {
  return {[expected = std::move(expected), is_right = std::move(is_right)](std::string& text) {
            return is_right(text) ? std::string() : refusal(expected, text);
          },
          ""};
}

/// Whether it is a whole number in that range; brings it into the form that CLI11, which takes leading zeros for the
/// mark of octal numbers, reads as the same.
bool make_whole(std::string& text, std::uint64_t least, std::uint64_t most) {
  const std::optional<std::uint64_t> value = parsed<std::uint64_t>(text);
  if (!value || *value < least || *value > most) return false;
  text = std::to_string(*value);
  return true;
}

CLI::Validator number_between(const std::string& expected, double least, double most) {
  return validator(expected, [least, most](const std::string& text) {
    const std::optional<double> value = parsed<double>(text);
    return value && std::isfinite(*value) && *value >= least && *value <= most;
  });
}

}  // namespace

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  return validator(fmt::format("a whole number from {} to {}", least, most),
                   [least, most](std::string& text) { return make_whole(text, least, most); });
}

CLI::Validator whole_number_from(std::uint64_t least) {
  return validator(fmt::format("a whole number of {} or more that fits 64 bits", least), [least](std::string& text) {
    return make_whole(text, least, std::numeric_limits<std::uint64_t>::max());
  });
}

CLI::Validator whole_number_or_0(std::uint64_t least, std::uint64_t most) {
  return validator(fmt::format("0, or a whole number from {} to {}", least, most), [least, most](std::string& text) {
    return make_whole(text, 0, 0) || make_whole(text, least, most);
  });
}

CLI::Validator number_not_negative() {
  return number_between("a finite number of 0 or more", 0, std::numeric_limits<double>::max());
}

CLI::Validator number_positive() {
  return number_between("a finite number above 0", std::numeric_limits<double>::min(),
                        std::numeric_limits<double>::max());
}

CLI::Validator number_from_to(double least, double most) {
  return number_between(fmt::format("a number from {} to {}", least, most), least, most);
}

CLI::Validator share() {
  return number_from_to(0, 1);
}

CLI::Validator one_of(std::vector<std::string> names) {
  const std::string expected = fmt::format("one of {}", fmt::join(names, ", "));
  const std::string name = fmt::format("{}{}", k_choices, fmt::join(names, " "));
  return validator(expected,
                   [names = std::move(names)](const std::string& text) {
                     return std::find(names.begin(), names.end(), text) != names.end();
                   })
      .name(name);
}

CLI::Validator directions() {
  return validator("directions x, y, z or three numbers each, as in x,y,1,1,0",
                   [](const std::string& text) { return parse_directions(text).has_value(); });
}

std::optional<std::vector<Eigen::Vector3d>> parse_directions(const std::string& text) {
  const std::vector<std::string> words = CLI::detail::split(text, ',');
  const std::array<std::string, 3> axes{"x", "y", "z"};
  std::vector<Eigen::Vector3d> found;
  for (std::size_t k = 0; k < words.size();) {
    const auto axis = std::ranges::find(axes, words[k]) - axes.begin();
    if (axis < 3) {
      found.emplace_back(Eigen::Vector3d::Unit(axis));
      ++k;
      continue;
    }
    Eigen::Vector3d vector;
    for (Eigen::Index c = 0; c < 3; ++c, ++k) {
      const std::optional<double> value = k < words.size() ? parsed<double>(words[k]) : std::nullopt;
      if (!value || !std::isfinite(*value)) return std::nullopt;
      vector[c] = *value;
    }
    if (!(vector.norm() > 0) || !std::isfinite(vector.norm())) return std::nullopt;
    found.push_back(vector.normalized());
  }
  return found.empty() ? std::nullopt : std::optional(found);
}

CLI::Validator file_name() {
  return validator("the name of a file", [](const std::string& text) { return !text.empty(); }).name(k_file);
}

std::vector<std::string> choices_of(CLI::Option& option) {
  for (const std::string& name : validator_names(option)) {
    if (name.starts_with(k_choices)) return CLI::detail::split(name.substr(std::strlen(k_choices)), ' ');
  }
  return {};
}

bool names_a_file(CLI::Option& option) {
  const std::vector<std::string> names = validator_names(option);
  return std::find(names.begin(), names.end(), k_file) != names.end();
}

}  // namespace cloud2csg::app
