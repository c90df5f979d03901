#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

/// A model as all scripts (.scad, .csg, .FCMacro, .py) write it, whatever their words are.
namespace cloud2csg::script {

/// One statement: a primitive, the box that stands for all of space, a union of others (of none: the empty solid), or
/// the common part of `kept` less all of `removed`.
struct Step {
  enum class Kind { primitive, everything, union_of, common };
  Kind kind = Kind::union_of;
  PrimitiveIndex primitive = 0;           ///< Kind::primitive only
  std::vector<std::size_t> kept = {};     ///< the operands of a union; of a common part, at least one
  std::vector<std::size_t> removed = {};  ///< Kind::common only
};

/// Operands come before what they are operands of, each has one user, the last step is the solid.
struct Plan {
  std::vector<Step> steps;
  AlignedBox everything;  ///< finite
};

/// Without complements: what goes on without end is taken from, or cut at, the box of everything. Chains of the same
/// operation are one step. O(size), no recursion
[[nodiscard]] Plan plan_script(const Model& model);

/// Whether there is nothing to write: the solid is empty.
[[nodiscard]] bool is_empty(const Plan& plan);

/// The primitives of the plan, ascending, each once.
[[nodiscard]] std::vector<PrimitiveIndex> primitives_of(const Plan& plan);

}  // namespace cloud2csg::script
