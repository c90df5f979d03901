#pragma once

#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// The part of a model that decides whether points in and near one primitive are in the solid.
struct Neighbourhood {
  std::vector<PrimitiveIndex> members;  ///< the primitive and those whose bounds meet its own, ascending
  PrimitiveSet primitives;              ///< copies of the members
  CsgTree tree;                         ///< the model's, restricted to the members and numbered as `primitives`
};

/// For each primitive, those (itself included, ascending) whose bounds, grown by `margin` on every side, meet its own.
/// Unbounded primitives and expressions, whose reach is unknown, meet all. Ignores primitives that are not in `used`
/// (ascending) and gives them empty lists. O(n log n + pairs)
[[nodiscard]] std::vector<std::vector<PrimitiveIndex>> meeting_bounds(const PrimitiveSet& primitives,
                                                                      std::span<const PrimitiveIndex> used,
                                                                      double margin);

/// The neighbourhoods of the primitives in `used`, in their order. Within `margin` of the primitive's bounds, its
/// neighbourhood's tree contains the same points as the whole tree.
[[nodiscard]] std::vector<Neighbourhood> neighbourhoods(const Model& model, std::span<const PrimitiveIndex> used,
                                                        double margin);

}  // namespace cloud2csg
