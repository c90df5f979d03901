#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

/// A CSG tree for an exact-solid kernel: without complements, with few and wide operations.
namespace cloud2csg::brep {

/// A bounded primitive, a union (empty without operands), or the intersection of `kept` minus `removed`.
struct PlanNode {
  enum class Kind { primitive, union_of, common };
  Kind kind = Kind::union_of;
  PrimitiveIndex primitive = 0;           ///< Kind::primitive only
  std::vector<std::size_t> kept = {};     ///< operands of the union; at least one for Kind::common
  std::vector<std::size_t> removed = {};  ///< Kind::common only
};

/// Operands precede their users. No node is used twice.
struct SolidPlan {
  std::vector<PlanNode> nodes;
  std::size_t root = 0;
  /// The solid is all of space minus the root. Apart from half-spaces, only such a solid is unbounded.
  bool is_complement = false;
};

/// Merges nested unions and turns (a - b) - c and a - (b | c) into a less b and c. Complements move up (a | ~b becomes
/// ~(b - a)) until only the root may be one. O(size), no recursion.
[[nodiscard]] SolidPlan plan_solid(const CsgTree& tree);

/// The root's direct and indirect operands by height. The nodes of one level are independent.
[[nodiscard]] std::vector<std::vector<std::size_t>> levels_of(const SolidPlan& plan);

/// The tree of a node. O(its size)
[[nodiscard]] CsgTree tree_of(const SolidPlan& plan, std::size_t node);

}  // namespace cloud2csg::brep
