#include "field_arguments.hpp"

#include <stop_token>

namespace cloud2csg::app {
namespace {

/// Of a text of several sentences; without its full stop.
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
  // A switch that is on unless it is turned off has the option that does so only.
  if (field.option.empty() && !field.opposite.empty()) return {};
  const std::string name = option_name(field);
  return name.empty() ? name : "--" + name;
}

std::string FieldArguments::opposite_option(const OptionField& field) {
  return field.opposite.empty() ? std::string() : joined("--", field.opposite);
}

void FieldArguments::add_flags(const OptionField& field, bool now, bool paper, const std::string& group,
                               const std::string& path) {
  const std::string yes = long_option(field);
  const std::string no = opposite_option(field);
  const bool are_both = !yes.empty() && !no.empty();
  const auto add = [&](const std::string& name, std::string_view text, bool value) {
    const char* const mark = !are_both ? "" : value == now ? " (default)" : value == paper ? " (paper)" : "";
    const std::string help = respelled(first_sentence(text), path) + mark;
    return app_.add_flag(name, help)->group(group);
  };
  CLI::Option* const on = yes.empty() ? nullptr : add(yes, field.text, true);
  CLI::Option* const off = no.empty() ? nullptr : add(no, field.otherwise, false);
  if (are_both) off->excludes(on);
}

CLI::Option* FieldArguments::add_value(const OptionField& field, const ValueHelp& help, const std::string& group,
                                       const std::string& path) {
  const std::string name = long_option(field);
  if (app_.get_option_no_throw(name) != nullptr) return nullptr;
  const std::string names = field.letter == 0 ? name : joined("-", std::string_view(&field.letter, 1)) + "," + name;
  CLI::Option* const option =
      app_.add_option(names, CLI::callback_t(), respelled(first_sentence(field.text), path) + help.note);
  return option->type_name(help.type)->group(group)->default_str(help.default_value);
}

bool FieldArguments::is_given(const std::string& option) const {
  return !option.empty() && app_.get_option(option)->count() > 0;
}

}  // namespace cloud2csg::app
