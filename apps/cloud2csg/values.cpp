#include "values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
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

}  // namespace

template <typename Number>
CLI::Validator number_in(const OptionRange& range) {
  constexpr bool k_is_whole = std::is_integral_v<Number>;
  return {[range](std::string& text) {
            const std::optional<Number> value = parsed<Number>(text);
            if (!value || !std::isfinite(static_cast<double>(*value))) {
              return refusal(range_text(range, k_is_whole), text);
            }
            text = fmt::format("{}", *value);
            return range_fault(range, static_cast<double>(*value), k_is_whole);
          },
          ""};
}
template CLI::Validator number_in<int>(const OptionRange& range);
template CLI::Validator number_in<std::size_t>(const OptionRange& range);
template CLI::Validator number_in<double>(const OptionRange& range);

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

void ValueReader<std::vector<Eigen::Vector3d>>::check(CLI::Option& option, const OptionRange& /*range*/) {
  option.check(directions())->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(false);
}

void ValueReader<std::vector<Eigen::Vector3d>>::read(const std::vector<std::string>& texts,
                                                     std::vector<Eigen::Vector3d>& values) {
  values.clear();
  for (const std::string& text : texts) {
    const std::vector<Eigen::Vector3d> given = parse_directions(text).value();
    values.insert(values.end(), given.begin(), given.end());
  }
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
