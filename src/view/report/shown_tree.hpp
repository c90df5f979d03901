#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// A node of the n-ary tree: chains of one operation are one node, and a difference subtracts all but its first child.
struct ShownNode {
  Operation operation = Operation::empty;
  PrimitiveIndex primitive = 0;
  std::vector<std::size_t> children;  ///< indices of shown nodes, larger than this node's
  std::size_t parent = 0;             ///< the root's is the root
  std::size_t depth = 0;
  std::size_t root = 0;  ///< node of the binary tree with the same solid
};

/// The shown tree in reading order, parents before children. O(size), no recursion.
[[nodiscard]] std::vector<ShownNode> shown_tree(const CsgTree& tree);

}  // namespace cloud2csg
