#pragma once

#include <rapidcheck.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "cloud2csg/mesh.hpp"
#include "support/any_solid.hpp"

/// Solids and measures that several test files of this stage need.
namespace cloud2csg::shapes {

inline Primitive at(Shape shape, const Eigen::Vector3d& position = Eigen::Vector3d::Zero(),
                    const Eigen::Quaterniond& orientation = Eigen::Quaterniond::Identity()) {
  return {.id = "p", .shape = std::move(shape), .pose = {position, orientation.normalized()}, .displacement = {}};
}

inline TriangleMesh mesh_of(const CsgTree& tree, const PrimitiveSet& primitives, int resolution = 64) {
  return mesh_surface({.primitives = primitives, .tree = tree}, bounds_of({.primitives = primitives, .tree = tree}),
                      {.resolution = resolution});
}

inline TriangleMesh mesh_of(const Primitive& primitive, int resolution = 64) {
  return mesh_of(CsgTree::leaf(0), {primitive}, resolution);
}

/// Vertices - edges + faces: 2 for a ball, 0 for a torus, summed over the pieces.
inline int euler_characteristic(const TriangleMesh& mesh) {
  // A closed mesh has three edges for every two triangles.
  return static_cast<int>(mesh.vertices.size()) - static_cast<int>(mesh.triangles.size()) / 2;
}

inline Primitive any_primitive() {
  Primitive primitive{.id = "p", .shape = test::any_shape(), .pose = test::any_pose(0.5), .displacement = {}};
  // The bounds of an expression are its author's word on the displaced solid, so those above would no longer hold.
  const bool can_be_displaced = !std::holds_alternative<Expression>(primitive.shape);
  if (can_be_displaced && *rc::gen::inRange(0, 5) == 0)
    primitive.displacement = Displacement{.frequency = test::any_double(1, 8)};
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
  return std::filesystem::temp_directory_path() / ("cloud2csg_mesh_test_" + std::to_string(::getpid()) + "_" + name);
}

}  // namespace cloud2csg::shapes
