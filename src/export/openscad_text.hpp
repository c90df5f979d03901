#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/primitive.hpp"

/// Small parts of an OpenSCAD program.
namespace cloud2csg::openscad {

/// Writes lengths and positions: short, ten significant digits, and plain 0 for what is rounding of the model's size.
class NumberFormat {
 public:
  /// `scale`: the size of the model.
  explicit NumberFormat(double scale) : smallest_(1e-12 * scale) {}

  [[nodiscard]] std::string operator()(double number) const;
  [[nodiscard]] std::string operator()(const Eigen::Vector3d& vector) const;  ///< [x, y, z]

 private:
  double smallest_;
};

/// A module name for each primitive: its id as far as OpenSCAD allows, unique, no word that OpenSCAD knows.
[[nodiscard]] std::vector<std::string> module_names(const PrimitiveSet& primitives);

/// `// ` before each line.
[[nodiscard]] std::string comment(std::string_view text);

/// `translate(...) rotate(...) `, each left out where it does nothing. A solid of revolution about z is turned about
/// two axes only.
[[nodiscard]] std::string placement(const Primitive& primitive, const NumberFormat& number);

}  // namespace cloud2csg::openscad
