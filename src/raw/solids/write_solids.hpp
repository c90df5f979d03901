#pragma once

#include "raw/solids/decision_list.hpp"

namespace cloud2csg {

struct WrittenSolids {
  PrimitiveSet solids = {};
  CsgTree tree = {};
};

/// The terms of a list as solids, each once, after the known ones, and the list as a tree. An end that makes no
/// difference moves inward to the surface that does, then slightly into the indifferent space, so that faces of a
/// formula's parts do not coincide if avoidable. A rule that adds where no solid can subtract, such as the inside of a
/// cylinder of many diagonals, is intersected with a box around the part. O(rules^2 x places).
[[nodiscard]] WrittenSolids write_solids(const TermSpace& space, DecisionList list);

}  // namespace cloud2csg
