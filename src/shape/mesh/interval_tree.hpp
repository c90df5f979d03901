#pragma once

#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

struct Interval {
  double low;
  double high;
};

/// Within `radius` of a point where the primitive's implicit value is `value`.
[[nodiscard]] Interval value_near(const Primitive& primitive, double value, double radius);

struct PrunedTree {
  std::vector<CsgNode> nodes;  ///< postfix: the tree without the branches that cannot decide the value
  Interval value;
};

/// The tree within a region where each primitive's value lies in its interval, by primitive index: exactly the same
/// values there, from fewer nodes. In a small region most of a large tree vanishes.
[[nodiscard]] PrunedTree prune(std::span<const CsgNode> tree, std::span<const Interval> primitive_values);

}  // namespace cloud2csg
