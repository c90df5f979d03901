#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <algorithm>
#include <charconv>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "command.hpp"

/// Options structs as options of a command, made from their tables.
namespace cloud2csg::app {

// What the text of an option's value must be. Each refuses anything else in one line that says what was expected and
// what was found; those of CLI11 are terse, take not-a-number for a number and 010 for 8.

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

/// Which fields of a struct a command has, and where.
template <typename Options>
struct FieldPlace {
  std::string group;                        ///< of the help
  std::string path = {};                    ///< where the struct stands in others, for messages: "extraction."
  std::optional<Options> paper = {};        ///< values of the preset `paper`, where the command has presets
  std::vector<std::string_view> only = {};  ///< these fields; empty: all
};

class FieldArguments {
 public:
  explicit FieldArguments(CLI::App& app) : app_(app) {}

  /// Adds the options of a struct's fields; their defaults are the values that it has. Fields whose options have one
  /// name share it. What is given goes into `options` by take(), so it must live as long as this.
  template <HasOptionTable Options>
  void add(Options& options, const FieldPlace<std::type_identity_t<Options>>& place) {
    note_names<Options>(place.path);
    add_fields(options, place.paper.value_or(options), place);
    takes_.emplace_back([&options, path = place.path] { validate(options, path); });
  }

  /// Gives the structs what the command line gave. @throws CLI::ValidationError naming the option for values that are
  /// each right, but not together.
  void take() const;

  /// An error of the library in the words of the command line: options for the names of fields.
  [[nodiscard]] Error respelled(const Error& error) const;

 private:
  struct Name {
    std::string path, option;  ///< "search.elites", "--elites"; none where the command line has none
  };
  /// What is shown of a value.
  struct ValueHelp {
    std::string type;                ///< "N"
    std::string default_value = {};  ///< empty: told in the note
    std::string note = {};           ///< what to add to the help: " (default: none)"
  };

  template <typename Options>
  void note_names(const std::string& path) {
    for_each_field<Options>([&](auto member, const OptionField& field) {
      using Value = std::remove_cvref_t<decltype(std::declval<Options>().*member)>;
      const std::string name = path + std::string(field.name);
      names_.push_back({.path = name, .option = long_option(field)});
      if constexpr (HasOptionTable<Value>) {
        if (field.option != k_no_option) note_names<Value>(name + ".");
      }
    });
  }

  template <typename Options>
  void add_fields(Options& options, const Options& paper, const FieldPlace<Options>& place) {
    for_each_field<Options>([&](auto member, const OptionField& field) {
      using Value = std::remove_cvref_t<decltype(options.*member)>;
      const bool is_left_out = !place.only.empty() && std::ranges::find(place.only, field.name) == place.only.end();
      if (field.option == k_no_option || is_left_out) return;
      Value& value = options.*member;
      const std::string group(field.group.empty() ? std::string_view(place.group) : field.group);
      if constexpr (HasOptionTable<Value>) {
        add_fields(value, paper.*member,
                   FieldPlace<Value>{.group = group, .path = place.path + std::string(field.name) + "."});
      } else if constexpr (std::is_same_v<Value, bool>) {
        add_flags(field, value, paper.*member, group, place.path);
      } else if constexpr (IsReadable<Value>) {
        add_value(field, value, help_of(field, value, paper.*member), group, place.path);
      }
    });
  }

  /// An option that was not given has what is in force as its default once it is taken: for reports.
  template <typename Value>
  void add_value(const OptionField& field, Value& value, const ValueHelp& help, const std::string& group,
                 const std::string& path) {
    CLI::Option* option = app_.get_option_no_throw(long_option(field));
    if (option == nullptr) {
      option = add_option(field, help, group, path);
      ValueReader<Value>::check(*option, field.range);
    }
    takes_.emplace_back([option, &value, absent = std::string(field.absent)] {
      if (option->count() > 0) ValueReader<Value>::read(option->results(), value);
      const std::string text = value_text(value);
      option->default_str(text.empty() ? absent : text);
    });
  }

  template <typename Value>
  static ValueHelp help_of(const OptionField& field, const Value& now, const Value& paper) {
    ValueHelp help{.type = std::string(field.unit.empty() ? ValueReader<Value>::k_type : field.unit),
                   .default_value = value_text(now)};
    if constexpr (requires { ValueReader<Value>::names(); }) {
      help.note = "; one of " + CLI::detail::join(ValueReader<Value>::names(), ", ");
    }
    const std::string of_paper = value_text(paper);
    if (!help.default_value.empty() && help.default_value == of_paper) {
      // As CLI11 has it.
      if constexpr (requires { now.size(); }) help.default_value = "[" + value_text(now, ",") + "]";
      return help;
    }
    const std::string start = help.default_value.empty() ? std::string(field.absent) : help.default_value;
    if (start.empty()) return help;
    help.note += " (default: " + start + (of_paper == help.default_value ? "" : ", paper: " + of_paper) + ")";
    help.default_value.clear();
    return help;
  }

  static std::string long_option(const OptionField& field);
  static std::string opposite_option(const OptionField& field);
  void add_flags(const OptionField& field, bool& now, bool paper, const std::string& group, const std::string& path);
  CLI::Option* add_option(const OptionField& field, const ValueHelp& help, const std::string& group,
                          const std::string& path);
  /// With options for the `fields` that a text speaks of; of those at the path first.
  [[nodiscard]] std::string respelled(const std::string& text, const std::string& path) const;
  [[nodiscard]] const Name* name_of(const std::string& field, const std::string& path) const;

  CLI::App& app_;
  std::vector<std::function<void()>> takes_;
  std::vector<Name> names_;
};

/// A subcommand that `work` does, an object of a command's file. `add_options` adds its own options and those of its
/// structs; work.prepare() comes before these get what was given, work.settle() afterwards, where there are any.
template <typename Work>
[[nodiscard]] Command make_command(CLI::App& app, void (*add_options)(CLI::App&, Work&, FieldArguments&)) {
  auto work = std::make_shared<Work>();
  auto fields = std::make_shared<FieldArguments>(app);
  add_options(app, *work, *fields);
  if constexpr (requires { work->running; }) add_run_options(app, work->running);
  app.final_callback([&app, work, fields] {
    (void)app;  // for settle() only
    if constexpr (requires { work->prepare(); }) work->prepare();
    fields->take();
    if constexpr (requires { work->settle(app); }) work->settle(app);
  });
  return {.options = &app, .run = [work, fields](const std::stop_token& stop) {
            try {
              work->run(stop);
            } catch (const WrongUsage&) {
              throw;
            } catch (const WrongFile&) {
              throw;
            } catch (const Error& error) {
              throw fields->respelled(error);
            }
          }};
}

}  // namespace cloud2csg::app
