#pragma once

#include "cloud2csg/csg_tree.hpp"
#include "io/step/kernel.hpp"

namespace cloud2csg::brep {

/// A tree and its primitives, in which expressions are cut at their bounds, beyond which they mean nothing.
struct BoundedField {
  CsgTree tree;
  PrimitiveSet primitives;
};
[[nodiscard]] BoundedField bounded_field(const CsgTree& tree, const PrimitiveSet& primitives);

/// The volume of the part of a solid that is in `box`, by its implicit value: cells of an octree that are wholly in or
/// out count as they are, of those at the surface `2^levels` to a side are left, and each is judged by two random
/// points. The same for any number of threads. O(surface cells x size); where a primitive is an expression, nothing is
/// known between points, and all cells are judged (`2^min(levels, 6)` to a side).
/// @throws Cancelled
[[nodiscard]] VolumeEstimate tree_volume(const CsgTree& tree, const PrimitiveSet& primitives, const AlignedBox& box,
                                         int levels, const RunContext& run);

}  // namespace cloud2csg::brep
