#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

/// A CSG tree as a kernel of exact solids wants it: no complements, and as few, as wide operations as it can be.
namespace cloud2csg::brep {

/// A solid with ends: a primitive, a union of others (of none: the empty solid), or the common part of `kept` less all
/// of `removed`.
struct PlanNode {
  enum class Kind { primitive, union_of, common };
  Kind kind = Kind::union_of;
  PrimitiveIndex primitive = 0;           ///< Kind::primitive only
  std::vector<std::size_t> kept = {};     ///< the operands of a union; of a common part, at least one
  std::vector<std::size_t> removed = {};  ///< Kind::common only
};

/// Operands come before what they are operands of. No node is used twice.
struct SolidPlan {
  std::vector<PlanNode> nodes;
  std::size_t root = 0;
  /// The solid is all of space less the root: only then it goes on without end, half-spaces apart.
  bool is_complement = false;
};

/// Nested unions become one, (a - b) - c becomes a less b and c, a - (b | c) likewise, a | ~b becomes ~(b - a), and so
/// on upwards, until no complement is left but one at the root. O(size), no recursion.
[[nodiscard]] SolidPlan plan_solid(const CsgTree& tree);

/// The nodes that are operands of the root, directly or not, by height: those of one level do not depend on each other.
[[nodiscard]] std::vector<std::vector<std::size_t>> levels_of(const SolidPlan& plan);

/// The tree of a node. O(its size)
[[nodiscard]] CsgTree tree_of(const SolidPlan& plan, std::size_t node);

}  // namespace cloud2csg::brep
