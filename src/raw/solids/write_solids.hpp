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

/// Cuts off what leaves the bounds of the points on surfaces, `seen`, by more than two tolerances to a side where it
/// would have points if it was there: a tip that they miss by chance stays. One more solid, a box, ends the tree's
/// solid one tolerance beyond the bounds, so that it shares no face with the part, and goes on on the other sides.
/// `points`: all of them. Costs what find_bare_surface() costs. @throws Cancelled
[[nodiscard]] WrittenSolids without_what_sticks_out(WrittenSolids written, const AlignedBox& seen, const Points& points,
                                                    double tolerance, const RunContext& run = {});

}  // namespace cloud2csg
