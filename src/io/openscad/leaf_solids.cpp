#include "io/openscad/leaf_solids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "io/openscad/place_solid.hpp"

namespace cloud2csg::scad {
namespace {

using Eigen::Vector3d;

Eigen::Affine3d shifted(const Vector3d& by) {
  return Eigen::Affine3d(Eigen::Translation3d(by));
}

void require(bool is_right, const Arguments& arguments, const std::string& expected) {
  if (!is_right) refuse(arguments.text(), arguments.offset(), "expected " + expected);
}

/// A radius, or half of the diameter where that is given. Absent where neither is.
std::optional<double> radius_of(const Arguments& arguments, const char* radius, const char* diameter) {
  if (const std::optional<double> found = arguments.number(diameter)) return 0.5 * *found;
  return arguments.number(radius);
}

LeafSolid cube(const Arguments& arguments) {
  Vector3d size = Vector3d::Ones();
  if (const Value* const given = arguments.find("size"); given != nullptr) {
    if (given->kind == Value::Kind::list && given->items.size() != 3) arguments.fail(*given, "three numbers");
    size = given->kind == Value::Kind::list ? arguments.vector(*given, 0)
                                            : Vector3d(Vector3d::Constant(*arguments.number("size")));
  }
  require(size.minCoeff() > 0, arguments, "a cube whose sizes are above 0");
  return {.shape = Box{.size = size}, .frame = shifted(arguments.flag("center") ? Vector3d(0, 0, 0) : 0.5 * size)};
}

LeafSolid cylinder(const Arguments& arguments) {
  const double height = arguments.number("h").value_or(1);
  const std::optional<double> radius = radius_of(arguments, "r", "d");
  const double bottom = radius_of(arguments, "r1", "d1").value_or(radius.value_or(1));
  const double top = radius_of(arguments, "r2", "d2").value_or(radius.value_or(1));
  require(height > 0 && std::min(bottom, top) >= 0 && std::max(bottom, top) > 0, arguments,
          "a cylinder whose height and radii are above 0; one radius may be 0");
  const Vector3d shift(0, 0, arguments.flag("center") ? 0.0 : 0.5 * height);
  const double facets = std::floor(arguments.number("$fn").value_or(0));
  constexpr double k_most_corners = 8;  // drawn with so few, a circle is meant to have corners
  if (facets >= 3 && facets <= k_most_corners) {
    auto frustum = faceted_frustum(bottom, top, height, static_cast<int>(facets));
    if (const auto* misfit = std::get_if<Misfit>(&frustum)) {
      refuse(arguments.text(), arguments.offset(), misfit->expected);
    }
    return {.shape = std::get<Polytope>(std::move(frustum)), .frame = shifted(shift)};
  }
  if (bottom == top) return {.shape = Cylinder{.radius = bottom, .height = height}, .frame = shifted(shift)};
  return {.shape = Cone{.radius_bottom = bottom, .radius_top = top, .height = height}, .frame = shifted(shift)};
}

std::vector<std::size_t> face_of(const Arguments& arguments, const Value& value, std::size_t corners) {
  std::vector<std::size_t> face;
  face.reserve(value.items.size());
  for (const double number : arguments.numbers(value)) {
    if (!(number >= 0 && number < static_cast<double>(corners)) || number != std::floor(number)) {
      arguments.fail(value, fmt::format("numbers of points, 0 to {}", corners - 1));
    }
    face.push_back(static_cast<std::size_t>(number));
  }
  if (face.size() < 3) arguments.fail(value, "a face of three or more points");
  return face;
}

LeafSolid polyhedron(const Arguments& arguments) {
  const Value* const points = arguments.find("points");
  const Value* faces = arguments.find("faces");
  if (faces == nullptr) faces = arguments.find("triangles");
  require(points != nullptr && faces != nullptr, arguments, "a polyhedron with points and faces");
  if (points->kind != Value::Kind::list || points->items.empty()) arguments.fail(*points, "a list of points");
  if (faces->kind != Value::Kind::list) arguments.fail(*faces, "a list of faces");
  std::vector<Vector3d> corners;
  corners.reserve(points->items.size());
  for (const Value& point : points->items) {
    if (point.items.size() != 3) arguments.fail(point, "three numbers");
    corners.push_back(arguments.vector(point, 0));
  }
  std::vector<std::vector<std::size_t>> sides;
  sides.reserve(faces->items.size());
  for (const Value& face : faces->items) sides.push_back(face_of(arguments, face, corners.size()));
  auto polytope = convex_polytope(corners, sides);
  if (const auto* misfit = std::get_if<Misfit>(&polytope)) {
    refuse(arguments.text(), arguments.offset(), misfit->expected,
           "write a mesh, openscad -o part.stl FILE.scad, and extract the tree from that");
  }
  return {.shape = std::get<Polytope>(std::move(polytope))};
}

}  // namespace

double round_radius(const Statement& call, const Scope& scope, std::string_view text) {
  constexpr std::array<std::string_view, 1> k_order{"r"};
  constexpr std::array<std::string_view, 1> k_others{"d"};
  const Arguments arguments(call, k_order, k_others, scope, text);
  const double radius = radius_of(arguments, "r", "d").value_or(1);
  require(radius > 0, arguments, fmt::format("a {} whose radius is above 0", call.name));
  return radius;
}

Eigen::Vector2d square_size(const Statement& call, const Scope& scope, std::string_view text) {
  constexpr std::array<std::string_view, 2> k_order{"size", "center"};
  const Arguments arguments(call, k_order, {}, scope, text);
  require(!arguments.flag("center"), arguments, "a square that begins at the origin, not one with its centre there");
  const Value* const size = arguments.find("size");
  if (size == nullptr) return Eigen::Vector2d::Ones();
  if (size->kind == Value::Kind::list) return arguments.vector(*size, 0).head<2>();
  return Eigen::Vector2d::Constant(*arguments.number("size"));
}

std::optional<LeafSolid> leaf_solid(const Statement& call, const Scope& scope, std::string_view text) {
  if (call.name == "sphere") return LeafSolid{.shape = Sphere{.radius = round_radius(call, scope, text)}};
  if (call.name == "cube") {
    constexpr std::array<std::string_view, 2> k_order{"size", "center"};
    return cube(Arguments(call, k_order, {}, scope, text));
  }
  if (call.name == "cylinder") {
    constexpr std::array<std::string_view, 4> k_order{"h", "r1", "r2", "center"};
    constexpr std::array<std::string_view, 4> k_others{"r", "d", "d1", "d2"};
    return cylinder(Arguments(call, k_order, k_others, scope, text));
  }
  if (call.name == "polyhedron") {
    constexpr std::array<std::string_view, 3> k_order{"points", "faces", "convexity"};
    constexpr std::array<std::string_view, 1> k_others{"triangles"};
    return polyhedron(Arguments(call, k_order, k_others, scope, text));
  }
  return std::nullopt;
}

}  // namespace cloud2csg::scad
