#include "field_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace cloud2csg::app {
namespace {

// Names that identify validators.
constexpr const char* k_choices = "one of ";
constexpr const char* k_file = "file";

/// CLI11 does not report the number of validators and throws after the last.
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

/// `is_right` checks a text and may rewrite it for CLI11.
template <typename IsRight>
CLI::Validator validator(std::string expected, IsRight is_right) {
  return {[expected = std::move(expected), is_right = std::move(is_right)](std::string& text) {
            return is_right(text) ? std::string() : refusal(expected, text);
          },
          ""};
}

std::string first_sentence(std::string_view text) {
  for (std::size_t i = 1; i < text.size(); ++i) {
    const bool is_end = i + 1 == text.size() || text[i + 1] == ' ';
    if (text[i] == '.' && text[i - 1] != '.' && is_end) return std::string(text.substr(0, i));
  }
  return std::string(text);
}

std::string joined(std::string_view dashes, std::string_view name) {
  return std::string(dashes) + std::string(name);
}

}  // namespace

template <typename Number>
CLI::Validator number_in(const OptionRange& range) {
  constexpr bool k_is_whole = std::is_integral_v<Number>;
  OptionRange told = range;
  if (std::is_unsigned_v<Number>) told.least = std::max(told.least, 0.0);
  return {[range = told](std::string& text) {
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

void FieldArguments::take() const {
  try {
    for (const std::function<void()>& take_one : takes_) take_one();
  } catch (const Error& error) {
    const Error told = respelled(error);
    throw CLI::ValidationError(told.parts().where, told.parts().expected);
  }
}

Error FieldArguments::respelled(const Error& error) const {
  Error::Parts parts = error.parts();
  const auto known = std::ranges::find(names_, parts.where, &Name::path);
  const std::string path = parts.where.substr(0, parts.where.rfind('.') + 1);
  if (known != names_.end() && !known->option.empty()) parts.where = known->option;
  parts.expected = respelled(parts.expected, path);
  parts.remedy = respelled(parts.remedy, path);
  return Error(std::move(parts));
}

std::string FieldArguments::respelled(const std::string& text, const std::string& path) const {
  std::string told;
  std::size_t at = 0;
  for (std::size_t mark = 0; (mark = text.find('`', at)) != std::string::npos;) {
    const std::size_t end = text.find('`', mark + 1);
    const Name* const known = end == std::string::npos ? nullptr : name_of(text.substr(mark + 1, end - mark - 1), path);
    const std::size_t next = known == nullptr ? mark + 1 : end + 1;
    told += text.substr(at, known == nullptr ? next - at : mark - at);
    if (known != nullptr) told += known->option.empty() ? text.substr(mark + 1, end - mark - 1) : known->option;
    at = next;
  }
  return told + text.substr(at);
}

const FieldArguments::Name* FieldArguments::name_of(const std::string& field, const std::string& path) const {
  auto known = std::ranges::find(names_, path + field, &Name::path);
  if (known == names_.end()) {
    known = std::ranges::find_if(
        names_, [&field](const Name& name) { return name.path == field || name.path.ends_with("." + field); });
  }
  return known == names_.end() ? nullptr : &*known;
}

std::string FieldArguments::long_option(const OptionField& field) {
  // A switch that is on by default has only the option that turns it off.
  if (field.option.empty() && !field.opposite.empty()) return {};
  const std::string name = option_name(field);
  return name.empty() ? name : "--" + name;
}

std::string FieldArguments::opposite_option(const OptionField& field) {
  return field.opposite.empty() ? std::string() : joined("--", field.opposite);
}

void FieldArguments::add_flags(const OptionField& field, bool& now, bool paper, const std::string& group,
                               const std::string& path) {
  const std::string yes = long_option(field);
  const std::string no = opposite_option(field);
  const bool are_both = !yes.empty() && !no.empty();
  const auto add = [&](const std::string& name, std::string_view text, bool value) -> CLI::Option* {
    if (name.empty()) return nullptr;
    const char* const mark = !are_both ? "" : value == now ? " (default)" : value == paper ? " (paper)" : "";
    const std::string help = respelled(first_sentence(text), path) + mark;
    CLI::Option* const option = app_.add_flag(name, help)->group(group);
    takes_.emplace_back([option, &now, value] {
      if (option->count() > 0) now = value;
    });
    return option;
  };
  CLI::Option* const on = add(yes, field.text, true);
  CLI::Option* const off = add(no, field.otherwise, false);
  if (are_both) off->excludes(on);
}

CLI::Option* FieldArguments::add_option(const OptionField& field, const ValueHelp& help, const std::string& group,
                                        const std::string& path) {
  const std::string name = long_option(field);
  const std::string names = field.letter == 0 ? name : joined("-", std::string_view(&field.letter, 1)) + "," + name;
  return app_.add_option(names, CLI::callback_t(), respelled(first_sentence(field.text), path) + help.note)
      ->type_name(help.type)
      ->group(group)
      ->default_str(help.default_value);
}

}  // namespace cloud2csg::app
