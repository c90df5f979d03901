#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

/// What a tree says where only some of its primitives are: the way to work on a large model piece by piece.
namespace cloud2csg {

/// The tree with all primitives but `kept` (in any order) taken for the empty solid, and what follows from that: a
/// single constant, or a tree without constants in which no complement stands right on another. Where no other
/// primitive is, both contain the same points, and of its own leaves the result has those of the tree in their order,
/// each as often. Nothing else is simplified. O(size + largest index)
[[nodiscard]] CsgTree restrict_to(const CsgTree& tree, std::span<const PrimitiveIndex> kept);

/// restrict_to() of one tree, many times: O(k log k) for k kept leaves, however large the tree is.
class TreeRestriction {
 public:
  /// O(size log size) time and memory.
  explicit TreeRestriction(const CsgTree& tree);

  /// Equal to restrict_to(tree, kept). Repeated indices and those that are not in the tree change nothing.
  [[nodiscard]] CsgTree restrict_to(std::span<const PrimitiveIndex> kept) const;

 private:
  class Builder;
  using NodeIndex = std::uint32_t;

  void link_parents();
  void measure_paths();
  void build_shallowest();
  [[nodiscard]] std::vector<NodeIndex> leaves_of(std::span<const PrimitiveIndex> kept) const;
  [[nodiscard]] NodeIndex common_ancestor(NodeIndex a, NodeIndex b) const;
  [[nodiscard]] NodeIndex child_towards(NodeIndex ancestor, NodeIndex node) const;

  CsgTree tree_;
  // By node:
  std::vector<NodeIndex> parent_;  ///< of the root: itself
  std::vector<std::uint32_t> depth_;
  std::vector<bool> is_full_;  ///< when all primitives are empty, its subtree is all of space; else it is empty
  /// Steps from here to the root, on which all siblings are taken for constants, that turn inside out...
  std::vector<std::uint32_t> inversions_;
  /// ...and the depth of the nearest node, this one included, whose step to its parent forgets what it is; 0: none.
  std::vector<std::uint32_t> forgetting_depth_;
  /// shallowest_[k][i]: the node of least depth among i .. i + 2^k - 1.
  std::vector<std::vector<NodeIndex>> shallowest_;
  std::vector<NodeIndex> leaves_;        ///< nodes that are primitives, by primitive
  std::vector<std::size_t> leaf_begin_;  ///< by primitive: its first in leaves_; one more at the end
};

}  // namespace cloud2csg
