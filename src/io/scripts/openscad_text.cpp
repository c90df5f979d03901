#include "io/scripts/openscad_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <sstream>
#include <variant>

namespace cloud2csg::openscad {
namespace {

using script::degrees_of;

/// Angles for OpenSCAD's rotate([x, y, z]): about x first, z last, in the fixed frame.
Eigen::Vector3d euler_angles(const Eigen::Matrix3d& m) {
  const double y = std::atan2(-m(2, 0), std::hypot(m(0, 0), m(1, 0)));
  constexpr double k_pole = 1e-9;
  if (std::hypot(m(0, 0), m(1, 0)) < k_pole) {
    // Looking along z: turning about x and about z is the same.
    return {degrees_of(std::atan2(-m(1, 2), m(1, 1))), degrees_of(y), 0.0};
  }
  return {degrees_of(std::atan2(m(2, 1), m(2, 2))), degrees_of(y), degrees_of(std::atan2(m(1, 0), m(0, 0)))};
}

/// Angles that turn the z axis into `axis`: about x alone if that does it, else about y, then z.
Eigen::Vector3d axis_angles(const Eigen::Vector3d& axis) {
  constexpr double k_flat = 1e-12;
  if (std::abs(axis.x()) < k_flat) return {degrees_of(std::atan2(-axis.y(), axis.z())), 0.0, 0.0};
  const double off_axis = std::hypot(axis.x(), axis.y());
  return {0.0, degrees_of(std::atan2(off_axis, axis.z())), degrees_of(std::atan2(axis.y(), axis.x()))};
}

}  // namespace

const std::set<std::string>& reserved_words() {
  static const std::set<std::string> words = [] {
    std::istringstream all(
        "assert assign child children circle color cube cylinder difference dxf_linear_extrude "
        "dxf_rotate_extrude each echo else everything false for function group hull if import import_dxf "
        "import_off import_stl include intersection intersection_for let linear_extrude minkowski mirror "
        "module multmatrix nothing offset parent_module polygon polyhedron projection render resize rotate "
        "rotate_extrude scale sphere square surface text translate true undef union use");
    return std::set<std::string>{std::istream_iterator<std::string>(all), {}};
  }();
  return words;
}

std::string list(const Eigen::Vector3d& vector, const script::NumberFormat& number) {
  return fmt::format("[{}]", number(vector));
}

Eigen::Vector3d rotation_angles(const Primitive& primitive) {
  const Eigen::Matrix3d matrix = primitive.pose.orientation.toRotationMatrix();
  if (primitive.displacement) return euler_angles(matrix);
  if (std::holds_alternative<Sphere>(primitive.shape)) return Eigen::Vector3d::Zero();
  const bool is_round = std::holds_alternative<Cylinder>(primitive.shape) ||
                        std::holds_alternative<Cone>(primitive.shape) || std::holds_alternative<Torus>(primitive.shape);
  return is_round ? axis_angles(matrix.col(2)) : euler_angles(matrix);
}

}  // namespace cloud2csg::openscad
