#pragma once

#include <filesystem>
#include <string>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/sample.hpp"

/// The models of the paper, clouds of them, and how alike two solids are.
namespace cloud2csg::test {

/// "m0" .. "m3".
inline Model paper_model(const std::string& name) {
  return read_model(std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / (name + ".json"));
}

inline Primitive placed(std::string id, Shape shape, const Eigen::Vector3d& position) {
  return {.id = std::move(id), .shape = std::move(shape), .pose = {.position = position}};
}

/// The bounds of all bounded solids.
inline AlignedBox bounds_of_all(const PrimitiveSet& primitives) {
  AlignedBox all;
  for (const Primitive& primitive : primitives) {
    const AlignedBox box = bounds(primitive);
    if (box.min().allFinite() && box.max().allFinite()) all.extend(box);
  }
  return all;
}

/// Points of a lattice over a box that is a little larger, and off the round numbers on which faces lie.
inline Points lattice(const AlignedBox& box, int points_a_side) {
  Points points;
  const Eigen::Vector3d step = 1.04 * box.sizes() / points_a_side;
  const Eigen::Vector3d first = box.min() - 0.0213 * box.sizes() + 0.4871 * step;
  for (int x = 0; x < points_a_side; ++x) {
    for (int y = 0; y < points_a_side; ++y) {
      for (int z = 0; z < points_a_side; ++z) points.push_back(first + step.cwiseProduct(Eigen::Vector3d(x, y, z)));
    }
  }
  return points;
}

/// Intersection over union of a solid and the true one, by membership on a lattice over the true one's primitives. 1
/// for two empty ones.
inline double membership_iou(const Model& result, const Model& truth, int points_a_side = 40) {
  const Points points = lattice(bounds_of_all(truth.primitives), points_a_side);
  const std::vector<double> in_result = implicit_value(result.tree.value(), result.primitives, points);
  const std::vector<double> in_truth = implicit_value(truth.tree.value(), truth.primitives, points);
  std::size_t both = 0;
  std::size_t either = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    both += in_result[i] < 0 && in_truth[i] < 0 ? 1 : 0;
    either += in_result[i] < 0 || in_truth[i] < 0 ? 1 : 0;
  }
  return either == 0 ? 1.0 : static_cast<double>(both) / static_cast<double>(either);
}

/// The same of two trees over the same primitives.
inline double membership_iou(const CsgTree& a, const CsgTree& b, const PrimitiveSet& primitives,
                             int points_a_side = 40) {
  return membership_iou({.primitives = primitives, .tree = a}, {.primitives = primitives, .tree = b}, points_a_side);
}

}  // namespace cloud2csg::test
