#pragma once

#include "raw/solids/decision_list.hpp"

namespace cloud2csg {

struct WrittenSolids {
  PrimitiveSet solids = {};
  CsgTree tree = {};
};

/// The terms of a list as solids, each once, after those that are known, and the list as a tree. Solids end where that
/// matters: an end that makes no difference is drawn in to the surface that does, and then moved a little into what
/// makes none, so that no two faces of the parts of a formula coincide where that can be helped. O(rules^2 x places).
[[nodiscard]] WrittenSolids write_solids(const TermSpace& space, DecisionList list);

}  // namespace cloud2csg
