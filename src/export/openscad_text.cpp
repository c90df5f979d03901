#include "export/openscad_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <variant>

namespace cloud2csg::openscad {
namespace {

/// Words of the language, its modules, and the modules that every file of ours may define.
constexpr std::array k_reserved = {"assert",
                                   "assign",
                                   "children",
                                   "circle",
                                   "color",
                                   "cube",
                                   "cylinder",
                                   "difference",
                                   "each",
                                   "echo",
                                   "else",
                                   "everything",
                                   "false",
                                   "for",
                                   "function",
                                   "group",
                                   "hull",
                                   "if",
                                   "import",
                                   "import_dxf",
                                   "import_off",
                                   "import_stl",
                                   "include",
                                   "intersection",
                                   "intersection_for",
                                   "let",
                                   "linear_extrude",
                                   "minkowski",
                                   "mirror",
                                   "module",
                                   "multmatrix",
                                   "offset",
                                   "parent_module",
                                   "polygon",
                                   "polyhedron",
                                   "projection",
                                   "render",
                                   "resize",
                                   "rotate",
                                   "rotate_extrude",
                                   "scale",
                                   "sphere",
                                   "square",
                                   "surface",
                                   "text",
                                   "translate",
                                   "true",
                                   "undef",
                                   "union",
                                   "use",
                                   "child",
                                   "dxf_linear_extrude",
                                   "dxf_rotate_extrude",
                                   "nothing"};

bool is_reserved(const std::string& word) {
  return std::any_of(k_reserved.begin(), k_reserved.end(), [&word](const char* known) { return word == known; });
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string identifier(const std::string& id) {
  std::string name;
  for (const char c : id) name += is_letter(c) || is_digit(c) ? c : '_';
  return name.empty() || is_digit(name[0]) ? "solid_" + name : name;
}

double degrees(double radians) {
  const double angle = radians * 180.0 / std::numbers::pi;
  // Angles of a quaternion carry its rounding; what is meant is the round number.
  const double rounded = std::round(angle);
  return std::abs(angle - rounded) < 1e-9 ? rounded + 0.0 : angle;
}

/// Angles for OpenSCAD's rotate([x, y, z]): about x first, z last, in the fixed frame.
Eigen::Vector3d euler_angles(const Eigen::Matrix3d& m) {
  const double y = std::atan2(-m(2, 0), std::hypot(m(0, 0), m(1, 0)));
  constexpr double k_pole = 1e-9;
  if (std::hypot(m(0, 0), m(1, 0)) < k_pole) {
    // Looking along z: turning about x and about z is the same.
    return {degrees(std::atan2(-m(1, 2), m(1, 1))), degrees(y), 0.0};
  }
  return {degrees(std::atan2(m(2, 1), m(2, 2))), degrees(y), degrees(std::atan2(m(1, 0), m(0, 0)))};
}

/// Angles that turn the z axis into `axis`: about x alone if that does it, else about y, then z.
Eigen::Vector3d axis_angles(const Eigen::Vector3d& axis) {
  constexpr double k_flat = 1e-12;
  if (std::abs(axis.x()) < k_flat) return {degrees(std::atan2(-axis.y(), axis.z())), 0.0, 0.0};
  const double off_axis = std::hypot(axis.x(), axis.y());
  return {0.0, degrees(std::atan2(off_axis, axis.z())), degrees(std::atan2(axis.y(), axis.x()))};
}

Eigen::Vector3d rotation_angles(const Primitive& primitive) {
  const Eigen::Matrix3d matrix = primitive.pose.orientation.toRotationMatrix();
  if (primitive.displacement) return euler_angles(matrix);
  if (std::holds_alternative<Sphere>(primitive.shape)) return Eigen::Vector3d::Zero();
  const bool is_round = std::holds_alternative<Cylinder>(primitive.shape) ||
                        std::holds_alternative<Cone>(primitive.shape) || std::holds_alternative<Torus>(primitive.shape);
  return is_round ? axis_angles(matrix.col(2)) : euler_angles(matrix);
}

}  // namespace

std::string NumberFormat::operator()(double number) const {
  return std::abs(number) <= smallest_ ? "0" : fmt::format("{:.10g}", number);
}

std::string NumberFormat::operator()(const Eigen::Vector3d& vector) const {
  return fmt::format("[{}, {}, {}]", (*this)(vector.x()), (*this)(vector.y()), (*this)(vector.z()));
}

std::vector<std::string> module_names(const PrimitiveSet& primitives) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const Primitive& primitive : primitives) {
    const std::string wanted = identifier(primitive.id);
    std::string name = wanted;
    for (int number = 2; is_reserved(name) || !taken.insert(name).second; ++number) {
      name = fmt::format("{}_{}", wanted, number);
    }
    names.push_back(name);
  }
  return names;
}

std::string comment(std::string_view text) {
  std::string lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    if (end > 0) lines += fmt::format("// {}\n", text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string placement(const Primitive& primitive, const NumberFormat& number) {
  const Eigen::Vector3d& position = primitive.pose.position;
  const Eigen::Vector3d angles = rotation_angles(primitive);
  const NumberFormat angle(1.0);
  const std::string offset = number(position);
  std::string text;
  if (offset != "[0, 0, 0]") text += fmt::format("translate({}) ", offset);
  if (!angles.isZero(0.0)) text += fmt::format("rotate({}) ", angle(angles));
  return text;
}

}  // namespace cloud2csg::openscad
