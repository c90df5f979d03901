#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "command.hpp"
#include "usage.hpp"
#include "values.hpp"

/// Options structs as options of a command, made from their tables.
namespace cloud2csg::app {

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
    takes_.emplace_back([this, &options, place] {
      take_fields(options, place.only);
      validate(options, place.path);
    });
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
  void add_fields(const Options& now, const Options& paper, const FieldPlace<Options>& place) {
    for_each_field<Options>([&](auto member, const OptionField& field) {
      using Value = std::remove_cvref_t<decltype(now.*member)>;
      if (field.option == k_no_option || !is_among(field.name, place.only)) return;
      const std::string group(field.group.empty() ? std::string_view(place.group) : field.group);
      if constexpr (HasOptionTable<Value>) {
        add_fields(now.*member, paper.*member,
                   FieldPlace<Value>{.group = group, .path = place.path + std::string(field.name) + "."});
      } else if constexpr (std::is_same_v<Value, bool>) {
        add_flags(field, now.*member, paper.*member, group, place.path);
      } else if constexpr (IsReadable<Value>) {
        CLI::Option* const option = add_value(field, help_of(field, now.*member, paper.*member), group, place.path);
        if (option != nullptr) ValueReader<Value>::check(*option, field.range);
      }
    });
  }

  /// Options that were not given have what is in force as their default from here on: for reports.
  template <typename Options>
  void take_fields(Options& options, const std::vector<std::string_view>& only = {}) const {
    for_each_field<Options>([&](auto member, const OptionField& field) {
      using Value = std::remove_cvref_t<decltype(options.*member)>;
      if (field.option == k_no_option || !is_among(field.name, only)) return;
      Value& value = options.*member;
      if constexpr (HasOptionTable<Value>) {
        take_fields(value);
      } else if constexpr (std::is_same_v<Value, bool>) {
        if (is_given(long_option(field))) value = true;
        if (is_given(opposite_option(field))) value = false;
      } else if constexpr (IsReadable<Value>) {
        CLI::Option& option = *app_.get_option(long_option(field));
        if (option.count() > 0) ValueReader<Value>::read(option.results(), value);
        const std::string text = value_text(value);
        option.default_str(text.empty() ? std::string(field.absent) : text);
      }
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
  static bool is_among(std::string_view name, const std::vector<std::string_view>& only) {
    return only.empty() || std::ranges::find(only, name) != only.end();
  }
  void add_flags(const OptionField& field, bool now, bool paper, const std::string& group, const std::string& path);
  /// Nothing when there is an option of the name.
  CLI::Option* add_value(const OptionField& field, const ValueHelp& help, const std::string& group,
                         const std::string& path);
  [[nodiscard]] bool is_given(const std::string& option) const;
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
