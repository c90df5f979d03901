#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/primitive.hpp"

/// What scripts are made of, whatever their language. Names in a model are somebody else's text: they go into a script
/// as identifiers, as comments of one line or as quoted strings, in no other way.
namespace cloud2csg::script {

/// Writes lengths and positions: short, ten significant digits, and plain 0 for what is rounding of the model's size.
class NumberFormat {
 public:
  /// `scale`: the size of the model.
  explicit NumberFormat(double scale) : smallest_(1e-12 * scale) {}

  [[nodiscard]] std::string operator()(double number) const;
  [[nodiscard]] std::string operator()(const Eigen::Vector3d& vector) const;  ///< x, y, z

 private:
  double smallest_;
};

/// Angles of a quaternion carry its rounding: one that is within 1e-9 degrees of a whole number is that number.
[[nodiscard]] double degrees_of(double radians);

/// Gives out names of letters, digits and underlines, each once.
class UniqueNames {
 public:
  /// Names that are never given out.
  explicit UniqueNames(std::set<std::string> reserved) : taken_(std::move(reserved)) {}

  /// `wanted` as far as it can be had: other characters become underlines, a number makes it unique.
  [[nodiscard]] std::string take(const std::string& wanted);

 private:
  std::set<std::string> taken_;
};

/// A name for each primitive: its id as far as can be.
[[nodiscard]] std::vector<std::string> names_of(const PrimitiveSet& primitives, UniqueNames& names);

/// `prefix` before each line; control characters, which could end a line or the script, and bytes that are no UTF-8
/// become question marks.
[[nodiscard]] std::string comment(std::string_view text, std::string_view prefix);

/// A Python string, in double quotes and ASCII.
[[nodiscard]] std::string python_string(std::string_view text);

/// Words that Python keeps for itself.
[[nodiscard]] const std::set<std::string>& python_keywords();

}  // namespace cloud2csg::script
