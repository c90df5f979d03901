#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/sample.hpp"

namespace cloud2csg::testing_support {

/// A solid, and what is known about it in closed form.
struct KnownSolid {
  std::string name;
  PrimitiveSet primitives;
  CsgTree tree = CsgTree::leaf(0);
  double area = 0.0;
  double volume = 0.0;

  [[nodiscard]] Model model() const { return {.primitives = primitives, .tree = tree}; }
};

[[nodiscard]] inline Pose some_pose() {
  return {.position = {0.3, -1.2, 2.5},
          .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, -2, 0.5).normalized()))};
}

[[nodiscard]] inline KnownSolid solid_of(Shape shape, double area, double volume) {
  const std::string name(type_name(shape));
  return {.name = name,
          .primitives = {{.id = "p", .shape = std::move(shape), .pose = some_pose()}},
          .area = area,
          .volume = volume};
}

/// One of each shape, turned and moved.
[[nodiscard]] inline std::vector<KnownSolid> plain_solids() {
  constexpr double k_pi = std::numbers::pi;
  const double slant = std::hypot(1.5, 0.7);
  std::vector<KnownSolid> solids{
      solid_of(Box{{1, 2, 3}}, 22, 6),
      solid_of(Sphere{1.5}, 9 * k_pi, 4.5 * k_pi),
      solid_of(Cylinder{0.5, 2}, 2.5 * k_pi, 0.5 * k_pi),
      solid_of(Cone{1, 0.3, 1.5}, k_pi * (1.3 * slant + 1.09), k_pi * 0.5 * (1 + 0.3 + 0.09)),
      solid_of(Cone{0, 0.7, 1.5}, k_pi * (0.7 * std::hypot(1.5, 0.7) + 0.49), k_pi * 0.5 * 0.49),
      solid_of(Torus{2, 0.6}, 4.8 * k_pi * k_pi, 2 * 0.36 * 2 * k_pi * k_pi),
  };
  // A right prism over a right triangle with sides 1, 1, sqrt 2 and height 2; one plane says nothing new.
  const double half = std::numbers::sqrt2 / 2;
  solids.push_back(solid_of(
      Polytope{
          {{{-1, 0, 0}, 0}, {{0, -1, 0}, 0}, {{half, half, 0}, half}, {{0, 0, 1}, 1}, {{0, 0, -1}, 1}, {{0, 1, 0}, 5}}},
      1 + 2 * (2 + std::numbers::sqrt2), 1));
  return solids;
}

[[nodiscard]] inline Primitive at(std::string id, Shape shape, const Eigen::Vector3d& position) {
  return {.id = std::move(id), .shape = std::move(shape), .pose = {.position = position}};
}

/// Solids of several primitives, with hidden, cut and coinciding surfaces.
[[nodiscard]] inline std::vector<KnownSolid> combined_solids() {
  constexpr double k_pi = std::numbers::pi;
  const CsgTree a = CsgTree::leaf(0);
  const CsgTree b = CsgTree::leaf(1);
  const Box cube{{2, 2, 2}};
  return {
      {.name = "cube with a spherical hole",
       .primitives = {at("a", cube, {0, 0, 0}), at("b", Sphere{0.8}, {0, 0, 0})},
       .tree = subtract(a, b),
       .area = 24 + 4 * k_pi * 0.64,
       .volume = 8 - 4.0 / 3 * k_pi * 0.512},
      {.name = "sphere hidden in a cube",
       .primitives = {at("a", cube, {0, 0, 0}), at("b", Sphere{0.8}, {0, 0, 0})},
       .tree = unite(a, b),
       .area = 24,
       .volume = 8},
      {.name = "two boxes end to end",
       .primitives = {at("a", cube, {0, 0, 0}), at("b", cube, {2, 0, 0})},
       .tree = unite(a, b),
       .area = 40,
       .volume = 16},
      {.name = "overlapping boxes with common planes",
       .primitives = {at("a", cube, {0, 0, 0}), at("b", cube, {1, 0, 0})},
       .tree = unite(a, b),
       .area = 32,
       .volume = 12},
      {.name = "the same box twice",
       .primitives = {at("a", Box{{1, 2, 3}}, {0, 0, 0}), at("b", Box{{1, 2, 3}}, {0, 0, 0})},
       .tree = intersect(a, b),
       .area = 22,
       .volume = 6},
      {.name = "drilled block",
       .primitives = {at("a", cube, {0, 0, 0}), at("b", Cylinder{0.5, 3}, {0, 0, 0})},
       .tree = subtract(a, b),
       .area = 24 - 0.5 * k_pi + 2 * k_pi,
       .volume = 8 - 0.5 * k_pi},
      {.name = "half a ball",
       .primitives = {at("a", Sphere{1}, {0, 0, 0}), at("b", HalfSpace{}, {0, 0, 0})},
       .tree = intersect(a, b),
       .area = 3 * k_pi,
       .volume = 2.0 / 3 * k_pi},
      {.name = "the other half of the ball",
       .primitives = {at("a", Sphere{1}, {0, 0, 0}), at("b", HalfSpace{}, {0, 0, 0})},
       .tree = subtract(a, b),
       .area = 3 * k_pi,
       .volume = 2.0 / 3 * k_pi},
      {.name = "lens",
       .primitives = {at("a", Sphere{1}, {0, 0, -0.5}), at("b", Sphere{1}, {0, 0, 0.5})},
       .tree = intersect(a, b),
       .area = 2 * k_pi,
       .volume = 2 * k_pi * 0.25 * (3 - 0.5) / 3},
  };
}

/// A cube that a far larger solid cuts, by shape. A surface of radius 1e4 is practically flat.
[[nodiscard]] inline std::vector<KnownSolid> cut_cubes() {
  constexpr double k_pi = std::numbers::pi;
  const auto less = [](Shape shape, const Eigen::Vector3d& position, double area, double volume) {
    return KnownSolid{.name = "cube less a far larger " + std::string(type_name(shape)),
                      .primitives = {at("a", Box{{2, 2, 2}}, {0, 0, 0}), at("b", std::move(shape), position)},
                      .tree = subtract(CsgTree::leaf(0), CsgTree::leaf(1)),
                      .area = area,
                      .volume = volume};
  };
  const Profile disc{{{{{1e4, 0}, 1}, {{-1e4, 0}, 1}}}};
  const Profile triangle{{{{{1e4, -1e4}}, {{3e4, -1e4}}, {{1e4, 1e4}}}}};
  const Profile half_square{{{{{0, -1e4}}, {{1e4, -1e4}}, {{1e4, 1e4}}, {{0, 1e4}}}}};
  const double third = std::sqrt(1.0 / 3);
  const double half = std::sqrt(0.5);
  return {
      less(Box{{1e4, 1e4, 1e4}}, {5e3, 5e3, 5e3}, 24, 7),
      less(Box{{1e4, 1e4, 0.005}}, {0, 0, 0}, 2 * (8 + 8 * 0.9975), 8 - 4 * 0.005),
      less(Cylinder{0.1, 1e4}, {0, 0, 0}, 24 + 2 * k_pi * (0.2 - 0.01), 8 - k_pi * 0.02),
      less(Cylinder{1e4, 3e4}, {1e4, 0, 0}, 16, 4),
      less(Cone{2e4, 0, 2e4}, {0, 0, -1e4 - 0.5}, 24 + 0.25 * k_pi * (std::sqrt(2.0) - 1), 8 - k_pi / 24),
      less(Sphere{1e4}, {0, 0, 1e4}, 16, 4),
      less(Torus{1e4, 0.5}, {1e4, 0, 0}, 24 + 1.5 * k_pi, 8 - 0.5 * k_pi),
      less(Extrusion{disc, 2e4}, {1e4, 0, 1e4}, 22, 6),
      less(Revolution{triangle}, {-1e4, 0, 0}, 16, 4),
      less(Revolution{half_square, 90}, {0, 0, 0}, 22, 6),
      less(Revolution{half_square, 270}, {0, 0, 0}, 10, 2),
      less(Revolution{half_square, 180}, {0, -0.5, 0}, 12, 2),
      less(Revolution{half_square, 300}, {-5e3, 3e3, 0}, 24, 8),
      less(Polytope{{{{0, 0, 1}, 0},
                     {{half, 0, -half}, 1e4},
                     {{-third, third, -third}, 1e4},
                     {{-third, -third, -third}, 1e4}}},
           {0, 0, 0}, 16, 4),
  };
}

/// Solids of which only the field is known.
[[nodiscard]] inline std::vector<KnownSolid> field_solids() {
  constexpr double k_pi = std::numbers::pi;
  const AlignedBox bounds(Eigen::Vector3d::Constant(-1.2), Eigen::Vector3d::Constant(1.2));
  return {solid_of(Expression{"sqrt(x^2+y^2+z^2)-1", bounds}, 4 * k_pi, 4.0 / 3 * k_pi),
          solid_of(Expression{"x^2+y^2+z^2-1", bounds}, 4 * k_pi, 4.0 / 3 * k_pi)};
}

}  // namespace cloud2csg::testing_support
