#pragma once

#include <numbers>
#include <string>

#include "cloud2csg/model.hpp"

namespace cloud2csg::test {

/// A disc with a bore and a turned circle of six holes, off the origin, and a row of four feet: what repeats.
inline Model flange() {
  Model model;
  const Eigen::Vector3d centre(30, 20, 5);
  const auto add = [&model](std::string id, Shape shape, const Pose& pose) {
    model.primitives.push_back({.id = std::move(id), .shape = std::move(shape), .pose = pose});
    return CsgTree::leaf(static_cast<PrimitiveIndex>(model.primitives.size() - 1));
  };
  CsgTree tree = add("disc", Cylinder{.radius = 20, .height = 8}, {.position = centre});
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d position = centre + Eigen::Vector3d(8.0 * i - 12, -14, 4);
    tree = unite(tree, add("foot " + std::to_string(i), Box{.size = {3, 3, 6}}, {.position = position}));
  }
  tree = subtract(tree, add("bore", Cylinder{.radius = 6, .height = 20}, {.position = centre}));
  for (int i = 0; i < 6; ++i) {
    const double angle = (10 + 60 * i) * std::numbers::pi / 180;
    const Eigen::Vector3d outward(std::cos(angle), std::sin(angle), 0);
    // Inclined, such that they have to turn with the circle.
    const Pose pose = pose_from_axis(centre + 14 * outward, Eigen::Vector3d::UnitZ() + 0.2 * outward);
    tree = subtract(tree, add("hole " + std::to_string(i), Cylinder{.radius = 2, .height = 20}, pose));
  }
  model.tree = tree;
  return model;
}

}  // namespace cloud2csg::test
