#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// A tree with what is needed to look for subtrees that it shares with others.
///
/// Its nodes other than unions are **operands**, each of exactly one **group**: the maximal union that it belongs to,
/// which may be of one operand only. A subtree is then one or more operands of a group. A group is valid when its top
/// is reached from the root through unions and first children of differences; all its operands are then valid merge
/// nodes.
struct MergeCandidate {
  struct Operand {
    std::uint64_t hash;  ///< structural_hash of the subtree
    std::uint32_t group;
    std::uint32_t node;
    std::uint32_t size;
  };
  CsgTree tree;
  std::vector<PrimitiveIndex> primitives;  ///< ascending
  std::vector<std::uint32_t> group_top;    ///< node index by group; groups are numbered from the root down
  std::vector<Operand> operands;           ///< all, from the root down
  std::vector<Operand> merge_nodes;        ///< those of valid groups, by hash, then from the root down
};

/// O(size log size).
[[nodiscard]] MergeCandidate make_merge_candidate(CsgTree tree);

/// A common subtree at a valid place of the larger of two trees.
struct CommonSubtree {
  std::size_t size;                  ///< nodes, its operands joined
  std::uint32_t group;               ///< of the larger tree
  std::vector<std::uint32_t> nodes;  ///< roots of its operands in the larger tree, ascending
};

/// The largest common subtree with a valid merge node in `larger`; of equal ones the nearest to the roots.
/// O(size of smaller x log size of larger).
[[nodiscard]] std::optional<CommonSubtree> largest_common_subtree(const MergeCandidate& larger,
                                                                  const MergeCandidate& smaller);

/// `larger` with `replacement` in the place of the common subtree, not simplified. O(size).
[[nodiscard]] CsgTree put_in_place(const MergeCandidate& larger, const CommonSubtree& common,
                                   const CsgTree& replacement);

}  // namespace cloud2csg
