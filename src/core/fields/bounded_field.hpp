#pragma once

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// A tree and its primitives, every value of which means something everywhere.
struct BoundedField {
  CsgTree tree;
  PrimitiveSet primitives;  ///< the caller's, and boxes added for cutting
};

/// Every leaf that is an expression becomes its intersection with the box of its bounds, beyond which its formula means
/// nothing. O(size x expressions)
[[nodiscard]] BoundedField bounded_field(const CsgTree& tree, const PrimitiveSet& primitives);

}  // namespace cloud2csg
