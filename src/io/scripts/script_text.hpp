#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/primitive.hpp"

/// Script text in any language. Names in a model are others' text: only identifiers, one-line comments, quoted strings.
namespace cloud2csg::script {

/// Writes lengths and positions with ten significant digits, and rounding errors of the model's size as plain 0.
class NumberFormat {
 public:
  /// `scale`: the size of the model.
  explicit NumberFormat(double scale) : smallest_(1e-12 * scale) {}

  [[nodiscard]] std::string operator()(double number) const;
  [[nodiscard]] std::string operator()(const Eigen::Vector3d& vector) const;  ///< x, y, z

 private:
  double smallest_;
};

/// Rounds an angle within 1e-9 degrees of a whole number, because quaternions carry rounding errors.
[[nodiscard]] double degrees_of(double radians);

/// Gives out unique names of letters, digits and underscores.
class UniqueNames {
 public:
  /// Never gives out the reserved names.
  explicit UniqueNames(std::set<std::string> reserved) : taken_(std::move(reserved)) {}

  /// A unique name like `wanted`: replaces other characters by underscores and adds a number if needed.
  [[nodiscard]] std::string take(const std::string& wanted);

 private:
  std::set<std::string> taken_;
};

/// A name for each primitive, as close to its id as possible.
[[nodiscard]] std::vector<std::string> names_of(const PrimitiveSet& primitives, UniqueNames& names);

/// Puts `prefix` before each line. Control characters, which could end it, and invalid UTF-8 become question marks.
[[nodiscard]] std::string comment(std::string_view text, std::string_view prefix);

/// A Python string, in double quotes and ASCII.
[[nodiscard]] std::string python_string(std::string_view text);

[[nodiscard]] const std::set<std::string>& python_keywords();

}  // namespace cloud2csg::script
