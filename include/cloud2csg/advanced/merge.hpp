#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

/// Merging the trees of the partitions into one (section 4 of the paper).
namespace cloud2csg {

enum class MergeOrder {
  paper,                   ///< the head of the list with the next trees; the merged tree is the new head
  largest_common_subtree,  ///< always the two trees with the largest valid common subtree
  // Long lists are first shortened by rounds in which each tree merges with the first possible partner.
};

struct MergeResult {
  std::vector<CsgTree> trees;  ///< one tree after a complete merge; else ordered by the first input of each
  std::size_t merges = 0;
  std::size_t blocked = 0;  ///< pairs of `trees` with a common primitive but no valid merge node
};

/// Merges trees that share subtrees, as in the paper. Simplifies all inputs and every merged tree.
///
/// Two trees merge at their largest common subtree that has a **valid merge node** in the larger tree (the first of two
/// equally large trees). A node is valid when the path from the root to it passes only unions (by any child) and
/// differences (by the first child). The smaller tree replaces that node. Where the paper leaves a choice:
/// - Common means equal up to the order of operands. Any subset of a union's operands counts as a subtree, however the
///   chain is stored: a | b | c and (c | b) - d have b | c in common.
/// - Only the larger tree needs a valid node, and must have it, since the smaller one is inserted whole.
/// - Among common subtrees of equal size, and among valid nodes, the nearest to the root wins.
/// - If the head merges with no other tree, the next one becomes the head. Skipped trees are tried again after other
///   merges. The merge ends when no two trees of the list merge.
/// - Trees that simplify to the empty solid are left out, unless all do.
///
/// Looks only at formulas. The caller must verify that trees agree where they overlap, and join trees that stay apart
/// (over disjoint primitives, or blocked by an intersection above everything that they share). Deterministic. O(size x
/// log^2 size) for long lists of trees that each share primitives with few others; else O(merges x (trees + size of the
/// result x log size)), plus O(size) per blocked pair. A triggered run.stop ends it between two merges.
[[nodiscard]] MergeResult merge_trees(std::span<const CsgTree> trees, MergeOrder order = MergeOrder::paper,
                                      const RunContext& run = {});

/// Merges trees by the role of their primitives, beyond the paper. A primitive wholly in the solid in all trees of its
/// cliques is united with the rest. One that is wholly out is subtracted from it. Either way it is removed from all
/// trees. The trees then describe only the space outside of it, which reveals further primitives. A tree without a
/// primitive of its clique covers it by others, which must be removed first. merge_trees() merges what remains, such as
/// a & b. Finally the removed primitives are put back once each, the first one outermost.
///
/// Correct where each tree is right near its primitives in all of space, and nothing remains; remainders are merged by
/// formula only. Assumes bounded solids. `trees` and `cliques` correspond. The result is one tree; `blocked` remainders
/// are united. Deterministic. O(size x log size) for trees that share primitives with few others.
[[nodiscard]] MergeResult merge_by_dominance(std::span<const CsgTree> trees, std::span<const Clique> cliques,
                                             const RunContext& run = {});

}  // namespace cloud2csg
