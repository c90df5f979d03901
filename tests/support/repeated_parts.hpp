#pragma once

#include <string>

#include "cloud2csg/model.hpp"
#include "io/scripts/parts.hpp"

namespace cloud2csg::test {

/// Adds the solids of a part to the model, and gives the tree over them.
inline CsgTree add_part(Model& model, const script::Part& part) {
  if (part.kind == script::Part::Kind::solid) {
    model.primitives.push_back(part.solid);
    model.primitives.back().id += " " + std::to_string(model.primitives.size());
    return CsgTree::leaf(static_cast<PrimitiveIndex>(model.primitives.size() - 1));
  }
  CsgTree tree = add_part(model, part.kept.front());
  for (std::size_t i = 1; i < part.kept.size(); ++i) {
    const CsgTree operand = add_part(model, part.kept[i]);
    tree = part.kind == script::Part::Kind::united ? unite(tree, operand) : intersect(tree, operand);
  }
  for (const script::Part& operand : part.removed) tree = subtract(tree, add_part(model, operand));
  return tree;
}

inline script::Part part_of(std::string id, Shape shape, const Eigen::Vector3d& position) {
  return {.solid = {.id = std::move(id), .shape = std::move(shape), .pose = {.position = position}}};
}

/// Combinations that repeat: three bars in a row with three bores each; two angles, one the mirror image of the other
/// in a plane beside the origin; a pin that three balls in a row have in common; and on it all, a ball of its own.
inline Model repeated_parts() {
  using Kind = script::Part::Kind;
  Model model;
  script::Part bar{.kind = Kind::common, .kept = {part_of("bar", Box{.size = {9, 2, 2}}, {0, 0, 0})}};
  for (int i = 0; i < 3; ++i) {
    bar.removed.push_back(part_of("bore", Cylinder{.radius = 0.6, .height = 4}, {3.0 * i - 2.5, 0.1, 0}));
  }
  CsgTree tree = add_part(model, part_of("ball", Sphere{.radius = 1.5}, {1, 2, 9}));
  for (int i = 0; i < 3; ++i) tree = unite(tree, add_part(model, script::moved(bar, {.position = {0, 4.0 * i, 0}})));
  const script::Part angle{.kind = Kind::common,
                           .kept = {part_of("angle", Box{.size = {3, 2, 5}}, {7, 1, 1})},
                           .removed = {part_of("notch", Box{.size = {2, 3, 4}}, {8, 1.5, 2})}};
  tree = unite(tree, add_part(model, angle));
  tree = unite(tree, add_part(model, script::mirrored(angle, {.normal = Eigen::Vector3d::UnitX(), .offset = 0.5})));
  script::Part pin{.kind = Kind::common};
  for (int i = 0; i < 3; ++i) pin.kept.push_back(part_of("lens", Sphere{.radius = 3}, {-4 + 1.5 * i, 4, 6}));
  model.tree = unite(tree, add_part(model, pin));
  return model;
}

}  // namespace cloud2csg::test
