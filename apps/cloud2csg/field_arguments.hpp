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

/// Converts options structs to options of a command by their tables.
namespace cloud2csg::app {

// Validators with one-line errors that name the expected and the found value. CLI11's accept NaN and read 010 as 8.

/// A decimal number in a range. Strips leading zeros, which CLI11 takes for octal.
template <typename Number>
[[nodiscard]] CLI::Validator number_in(const OptionRange& range);
[[nodiscard]] CLI::Validator one_of(std::vector<std::string> names);
/// A list of directions: see parse_directions().
[[nodiscard]] CLI::Validator directions();
/// Any non-empty text.
[[nodiscard]] CLI::Validator file_name();

/// The allowed values of an option checked by one_of().
[[nodiscard]] std::vector<std::string> choices_of(CLI::Option& option);
/// Whether file_name() checks the option's value.
[[nodiscard]] bool names_a_file(CLI::Option& option);

/// Directions separated by commas: x, y, z, or three numbers that are not all 0 ("x,y,1,1,0"). Absent for other text.
[[nodiscard]] std::optional<std::vector<Eigen::Vector3d>> parse_directions(const std::string& text);

/// The number, if it is the whole text and in the type's range.
template <typename Number>
[[nodiscard]] std::optional<Number> parsed(const std::string& text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  if (failure != std::errc{} || stop != end) return std::nullopt;
  return value;
}

// A trait per type that checks, reads and names its values.

/// Types without a specialisation have no option.
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

/// Lists of lengths are one word with commas; other lists have one word per value.
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

/// One word may hold several directions: see parse_directions().
template <>
struct ValueReader<std::vector<Eigen::Vector3d>> {
  static constexpr std::string_view k_type = "A,A...";
  static void check(CLI::Option& option, const OptionRange& range);
  static void read(const std::vector<std::string>& texts, std::vector<Eigen::Vector3d>& values);
};

/// Which fields of a struct a command has, and where.
template <typename Options>
struct FieldPlace {
  std::string group;
  std::string path = {};                    ///< path of a nested struct for messages: "extraction."
  std::optional<Options> paper = {};        ///< values of the preset `paper`, if the command has presets
  std::vector<std::string_view> only = {};  ///< only these fields; empty: all
};

class FieldArguments {
 public:
  explicit FieldArguments(CLI::App& app) : app_(app) {}

  /// Adds options for the fields of a struct, with its values as defaults. Fields with the same option name share one
  /// option. take() writes into `options`, which must outlive this object.
  template <HasOptionTable Options>
  void add(Options& options, const FieldPlace<std::type_identity_t<Options>>& place) {
    note_names<Options>(place.path);
    add_fields(options, place.paper.value_or(options), place);
    takes_.emplace_back([&options, path = place.path] { validate(options, path); });
  }

  /// Writes the options into the structs. @throws CLI::ValidationError naming the option when values conflict.
  void take() const;

  /// The error with options in place of field names.
  [[nodiscard]] Error respelled(const Error& error) const;

 private:
  struct Name {
    std::string path, option;  ///< "search.elites", "--elites"; empty without an option
  };
  struct ValueHelp {
    std::string type;                ///< "N"
    std::string default_value = {};  ///< empty: described in the note
    std::string note = {};           ///< suffix of the help: " (default: none)"
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

  /// When taken, an option that was not given gets the value in force as its default, for reports.
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
      // In CLI11's form.
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
  /// The text with options in place of `fields`; prefers fields at the path.
  [[nodiscard]] std::string respelled(const std::string& text, const std::string& path) const;
  [[nodiscard]] const Name* name_of(const std::string& field, const std::string& path) const;

  CLI::App& app_;
  std::vector<std::function<void()>> takes_;
  std::vector<Name> names_;
};

/// A subcommand whose action and options are those of a `Work`. `add_options` adds its options. work.prepare() runs
/// before values are set and work.settle() after, where they exist; work.fail() when the action failed.
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
  const auto run = [work, fields](const std::stop_token& stop) {
    try {
      if constexpr (std::is_void_v<decltype(work->run(stop))>) {
        work->run(stop);
        return k_done;
      } else {
        return work->run(stop);
      }
    } catch (const WrongUsage&) {
      throw;
    } catch (const WrongFile&) {
      throw;
    } catch (const Error& error) {
      throw fields->respelled(error);
    }
  };
  const auto fail = [work]([[maybe_unused]] std::string_view message) {
    if constexpr (requires { work->fail(message); }) work->fail(message);
  };
  return {.options = &app, .run = run, .fail = fail};
}

}  // namespace cloud2csg::app
