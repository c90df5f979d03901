#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

/// A model as all scripts (.scad, .csg, .FCMacro, .py) write it, independent of their words.
namespace cloud2csg::script {

/// A primitive, the box for all of space, a union (if empty, nothing), or the intersection of `kept` minus `removed`.
struct Step {
  enum class Kind { primitive, everything, union_of, common };
  Kind kind = Kind::union_of;
  PrimitiveIndex primitive = 0;           ///< Kind::primitive only
  std::vector<std::size_t> kept = {};     ///< operands of the union; at least one for Kind::common
  std::vector<std::size_t> removed = {};  ///< Kind::common only
};

/// Operands precede their users, each step has one user, and the last step is the solid.
struct Plan {
  std::vector<Step> steps;
  AlignedBox everything;  ///< finite
};

/// A plan without complements: the box of everything bounds infinite solids. One step a chain. O(size), no recursion
[[nodiscard]] Plan plan_script(const Model& model);

[[nodiscard]] bool is_empty(const Plan& plan);

/// The primitives of the plan, ascending, without duplicates.
[[nodiscard]] std::vector<PrimitiveIndex> primitives_of(const Plan& plan);

}  // namespace cloud2csg::script
