#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

/// Restricts a tree to a region that only some of its primitives reach, to work on a large model piece by piece.
namespace cloud2csg {

/// Replaces all primitives except `kept` (in any order) by the empty solid and folds constants. The result is a single
/// constant, or has neither constants nor double complements. It equals the tree wherever no other primitive reaches.
/// It keeps the kept leaves' order and repetitions, and simplifies nothing else. O(size + largest index)
[[nodiscard]] CsgTree restrict_to(const CsgTree& tree, std::span<const PrimitiveIndex> kept);

/// restrict_to() of one tree, many times: O(k log k) for k kept leaves, however large the tree.
class TreeRestriction {
 public:
  /// O(size log size) time and memory.
  explicit TreeRestriction(const CsgTree& tree);

  /// Equal to restrict_to(tree, kept). Repeated indices and indices outside of the tree change nothing.
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
  std::vector<NodeIndex> parent_;  ///< the root's is itself
  std::vector<std::uint32_t> depth_;
  std::vector<bool> is_full_;  ///< value of the subtree when all primitives are empty: all of space or empty
  /// Number of inverting steps from here to the root, when all siblings on the way are constants.
  std::vector<std::uint32_t> inversions_;
  /// Depth of the nearest node from here to the root whose step to its parent ignores its value; 0: none.
  std::vector<std::uint32_t> forgetting_depth_;
  /// shallowest_[k][i]: the node of least depth among i .. i + 2^k - 1.
  std::vector<std::vector<NodeIndex>> shallowest_;
  std::vector<NodeIndex> leaves_;        ///< primitive leaves, sorted by primitive
  std::vector<std::size_t> leaf_begin_;  ///< by primitive: index of its first leaf in leaves_; one more at the end
};

}  // namespace cloud2csg
