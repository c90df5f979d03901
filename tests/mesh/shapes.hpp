#pragma once

#include <rapidcheck.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "cloud2csg/mesh.hpp"

/// Solids and measures that several test files of this stage need.
namespace cloud2csg::shapes {

inline Primitive at(Shape shape, const Eigen::Vector3d& position = Eigen::Vector3d::Zero(),
                    const Eigen::Quaterniond& orientation = Eigen::Quaterniond::Identity()) {
  return {.id = "p", .shape = std::move(shape), .pose = {position, orientation.normalized()}, .displacement = {}};
}

inline TriangleMesh mesh_of(const CsgTree& tree, const PrimitiveSet& primitives, int resolution = 64) {
  return mesh_surface(tree, primitives, bounds_of(tree, primitives), {.resolution = resolution});
}

inline TriangleMesh mesh_of(const Primitive& primitive, int resolution = 64) {
  return mesh_of(CsgTree::leaf(0), {primitive}, resolution);
}

/// Vertices - edges + faces: 2 for a ball, 0 for a torus, summed over the pieces.
inline int euler_characteristic(const TriangleMesh& mesh) {
  // A closed mesh has three edges for every two triangles.
  return static_cast<int>(mesh.vertices.size()) - static_cast<int>(mesh.triangles.size()) / 2;
}

inline double any_double(double low, double high) {
  constexpr int k_steps = 1 << 20;
  return low + (high - low) * *rc::gen::inRange(0, k_steps) / k_steps;
}

inline Eigen::Vector3d any_vector(double low, double high) {
  const double x = any_double(low, high);
  const double y = any_double(low, high);
  return {x, y, any_double(low, high)};
}

inline Eigen::Quaterniond any_orientation() {
  const Eigen::Vector3d v = any_vector(-1, 1);
  return Eigen::Quaterniond(any_double(0.1, 1), v.x(), v.y(), v.z()).normalized();
}

inline Shape any_shape() {
  const double a = any_double(0.3, 0.8);
  const double b = any_double(0.05, 0.3);
  switch (*rc::gen::inRange(0, 8)) {
    case 0:
      return Box{.size = any_vector(0.1, 1)};
    case 1:
      return Sphere{.radius = a};
    case 2:
      return Cylinder{.radius = a, .height = b};
    case 3:
      return Cone{.radius_bottom = a, .radius_top = *rc::gen::arbitrary<bool>() ? b : 0.0, .height = a};
    case 4:
      return Torus{.major_radius = a, .minor_radius = b};
    case 5:
      return HalfSpace{};
    case 6:
      return Polytope{
          .planes = {{{-1, 0, 0}, a}, {{0, -1, 0}, b}, {{0, 0, -1}, a}, {{0.6, 0.8, 0}, a}, {{0, 0, 1}, b}}};
    default:
      return Expression{.distance = "sqrt(x^2 + y^2 + 2 * z^2) - 0.5",
                        .bounds = AlignedBox(Eigen::Vector3d::Constant(-0.5), Eigen::Vector3d::Constant(0.5))};
  }
}

inline Primitive any_primitive() {
  const Shape shape = any_shape();
  const Eigen::Vector3d position = any_vector(-0.5, 0.5);
  Primitive primitive = at(shape, position, any_orientation());
  // The bounds of an expression are its author's word on the displaced solid, so those above would no longer hold.
  const bool can_be_displaced = !std::holds_alternative<Expression>(shape);
  if (can_be_displaced && *rc::gen::inRange(0, 5) == 0)
    primitive.displacement = Displacement{.frequency = any_double(1, 8)};
  return primitive;
}

inline CsgTree any_tree(std::size_t leaves) {
  CsgTree tree = CsgTree::leaf(0);
  for (std::size_t i = 1; i < leaves; ++i) {
    const CsgTree leaf = CsgTree::leaf(static_cast<PrimitiveIndex>(i));
    switch (*rc::gen::inRange(0, 5)) {
      case 0:
        tree = intersect(tree, leaf);
        break;
      case 1:
        tree = subtract(tree, leaf);
        break;
      case 2:
        tree = unite(complement(leaf), tree);
        break;
      case 3:
        tree = subtract(leaf, tree);
        break;
      default:
        tree = unite(tree, leaf);
    }
  }
  return tree;
}

inline std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("cloud2csg_mesh_test_" + name);
}

}  // namespace cloud2csg::shapes
