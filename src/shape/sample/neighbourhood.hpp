#pragma once

#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// What of a model matters in and near one primitive: enough to tell whether a point there is in the solid.
struct Neighbourhood {
  std::vector<PrimitiveIndex> members;  ///< the primitive and those whose bounds meet its own, ascending
  PrimitiveSet primitives;              ///< copies of the members
  CsgTree tree;                         ///< the model's, restricted to the members and numbered as `primitives`
};

/// By primitive, the primitives whose bounds, grown by `margin` on every side, meet its own, itself included,
/// ascending. Those of unknown reach, unbounded ones and expressions, meet all. Only primitives out of `used`
/// (ascending) count; for others the list is empty. O(n log n + pairs)
[[nodiscard]] std::vector<std::vector<PrimitiveIndex>> meeting_bounds(const PrimitiveSet& primitives,
                                                                      std::span<const PrimitiveIndex> used,
                                                                      double margin);

/// The neighbourhoods of the primitives of `used`, in their order. Where a point is within `margin` of the bounds of
/// the primitive, the tree of its neighbourhood contains it if and only if the whole tree does.
[[nodiscard]] std::vector<Neighbourhood> neighbourhoods(const Model& model, std::span<const PrimitiveIndex> used,
                                                        double margin);

}  // namespace cloud2csg
