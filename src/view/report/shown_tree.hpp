#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// A node of the tree as people read it: a chain of unions or intersections is one node with many children, and a
/// difference is its first child less all others.
struct ShownNode {
  Operation operation = Operation::empty;
  PrimitiveIndex primitive = 0;       ///< of a leaf
  std::vector<std::size_t> children;  ///< indices of shown nodes, all larger than this one's
  std::size_t parent = 0;             ///< the root is its own
  std::size_t depth = 0;
  std::size_t root = 0;  ///< the node of the binary tree with the same solid
};

/// The root first, parents before their children, in reading order. O(size), no recursion.
[[nodiscard]] std::vector<ShownNode> shown_tree(const CsgTree& tree);

}  // namespace cloud2csg
