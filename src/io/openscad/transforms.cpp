#include "io/openscad/transforms.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace cloud2csg::scad {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

/// Exact at multiples of 90 degrees, as in OpenSCAD.
Eigen::Matrix3d turn(double degrees, const Vector3d& axis) {
  const double quarters = degrees / 90;
  if (quarters != std::round(quarters)) {
    return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis).toRotationMatrix();
  }
  constexpr std::array<double, 4> k_sines{0, 1, 0, -1};
  const auto quarter = static_cast<std::size_t>(std::fmod(std::fmod(quarters, 4) + 4, 4));
  const double sine = k_sines[quarter];
  const double cosine = k_sines[(quarter + 1) % 4];
  Eigen::Matrix3d across;
  across << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return cosine * Eigen::Matrix3d::Identity() + sine * across + (1 - cosine) * axis * axis.transpose();
}

Affine3d linear(const Eigen::Matrix3d& matrix) {
  Affine3d map = Affine3d::Identity();
  map.linear() = matrix;
  return map;
}

/// The only argument, which has to be given.
const Value& needed(const Arguments& arguments, std::string_view name) {
  const Value* const value = arguments.find(name);
  if (value == nullptr) {
    refuse(arguments.text(), arguments.offset(), "expected an argument '" + std::string(name) + "', found none");
  }
  return *value;
}

Affine3d rotation(const Arguments& arguments) {
  const Value& angle = needed(arguments, "a");
  if (angle.kind == Value::Kind::list) {
    const Vector3d angles = arguments.vector(angle, 0);
    return linear(turn(angles.z(), Vector3d::UnitZ()) * turn(angles.y(), Vector3d::UnitY()) *
                  turn(angles.x(), Vector3d::UnitX()));
  }
  Vector3d axis = Vector3d::UnitZ();
  if (const Value* const given = arguments.find("v"); given != nullptr) axis = arguments.vector(*given, 0);
  if (axis.isZero(0)) arguments.fail(*arguments.find("v"), "an axis with a length");
  return linear(turn(*arguments.number("a"), axis.normalized()));
}

Affine3d scaling(const Arguments& arguments) {
  const Value& factor = needed(arguments, "v");
  const Vector3d factors = factor.kind == Value::Kind::list ? arguments.vector(factor, 1)
                                                            : Vector3d(Vector3d::Constant(*arguments.number("v")));
  return linear(factors.asDiagonal());
}

Affine3d mirroring(const Arguments& arguments) {
  const Vector3d normal = arguments.vector(needed(arguments, "v"), 0);
  if (normal.isZero(0)) return Affine3d::Identity();
  const Vector3d unit = normal.normalized();
  return linear(Eigen::Matrix3d::Identity() - 2 * unit * unit.transpose());
}

Affine3d matrix(const Arguments& arguments) {
  const Value& rows = needed(arguments, "m");
  if (rows.kind != Value::Kind::list || rows.items.size() < 3 || rows.items.size() > 4) {
    arguments.fail(rows, "a matrix of three or four rows");
  }
  Affine3d map = Affine3d::Identity();
  for (Eigen::Index row = 0; row < static_cast<Eigen::Index>(rows.items.size()); ++row) {
    const Value& found = rows.items[static_cast<std::size_t>(row)];
    const std::vector<double> numbers = arguments.numbers(found);
    if (numbers.size() < 3 || numbers.size() > 4) arguments.fail(found, "a row of three or four numbers");
    for (std::size_t column = 0; column < numbers.size(); ++column) {
      map.matrix()(row, static_cast<Eigen::Index>(column)) = numbers[column];
    }
  }
  if (map.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1)) arguments.fail(rows.items[3], "a last row of 0, 0, 0, 1");
  return map;
}

}  // namespace

std::optional<Affine3d> transform_of(const Statement& call, const Scope& scope, std::string_view text) {
  const auto arguments = [&](std::initializer_list<std::string_view> order) {
    return Arguments(call, {order.begin(), order.size()}, {}, scope, text);
  };
  if (call.name == "translate") {
    const Arguments given = arguments({"v"});
    return Affine3d(Eigen::Translation3d(given.vector(needed(given, "v"), 0)));
  }
  if (call.name == "rotate") return rotation(arguments({"a", "v"}));
  if (call.name == "scale") return scaling(arguments({"v"}));
  if (call.name == "mirror") return mirroring(arguments({"v"}));
  if (call.name == "multmatrix") return matrix(arguments({"m"}));
  return std::nullopt;
}

}  // namespace cloud2csg::scad
