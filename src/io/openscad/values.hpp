#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/openscad/syntax.hpp"

namespace cloud2csg::scad {

struct Value {
  enum class Kind { undefined, number, boolean, text, list, range };
  Kind kind = Kind::undefined;
  std::size_t offset = 0;  ///< of the term that it is of
  double number = 0;
  std::vector<Value> items = {};  ///< of a range: from where, in steps of what, to where
};

/// Variables that are known at a place: its own, and those around it.
struct Scope {
  const Scope* outer = nullptr;
  std::map<std::string, Value, std::less<>> values = {};

  /// Null where there is none.
  [[nodiscard]] const Value* find(std::string_view name) const;
};

/// @throws Error for a name without a value, and what is no number where one is needed.
[[nodiscard]] Value evaluate(const Term& term, const Scope& scope, std::string_view text);

/// What the variable of a loop is in turn. @throws Error for anything but a list or range, and for more than `most`
[[nodiscard]] std::vector<Value> turns_of(const Value& value, std::size_t most, std::string_view text);

/// The arguments of a call by name.
class Arguments {
 public:
  /// `order` names those that may be told by their place; `others` those that may not. Names with $ are let be, but
  /// for what $fn says. @throws Error for an argument that is neither, or given twice, and as evaluate().
  Arguments(const Statement& call, std::span<const std::string_view> order, std::span<const std::string_view> others,
            const Scope& scope, std::string_view text);

  [[nodiscard]] const Value* find(std::string_view name) const;
  /// Absent where it is not given, or undef. @throws Error for anything but a number
  [[nodiscard]] std::optional<double> number(std::string_view name) const;
  /// @throws Error for anything but true and false
  [[nodiscard]] bool flag(std::string_view name) const;
  /// One to three numbers, those that are missing being `rest`. @throws Error for anything else
  [[nodiscard]] Eigen::Vector3d vector(const Value& value, double rest) const;
  /// Any count of numbers. @throws Error for anything else
  [[nodiscard]] std::vector<double> numbers(const Value& value) const;
  [[noreturn]] void fail(const Value& at, const std::string& expected) const;

  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] std::size_t offset() const { return offset_; }

 private:
  std::map<std::string, Value, std::less<>> values_ = {};
  std::string_view text_;
  std::size_t offset_;
};

}  // namespace cloud2csg::scad
