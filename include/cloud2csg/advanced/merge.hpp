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
  paper,                   ///< the head of the list with the next ones; the merged tree is the new head
  largest_common_subtree,  ///< always the two trees with the largest valid common subtree
  // Long lists are first made short by rounds in which each tree merges with the first that it can.
};

struct MergeResult {
  std::vector<CsgTree> trees;  ///< one when the merge went through; else by the first input that went into each
  std::size_t merges = 0;      ///< how often two trees became one
  std::size_t blocked = 0;     ///< pairs of `trees` that share a primitive and yet have no valid merge node
};

/// Merges trees that share subtrees, as in the paper. All are simplified first, and so is what comes of each merge.
///
/// Two trees merge at their largest common subtree that has a **valid merge node** in the larger tree (of equal ones:
/// in the first): an appearance reached from the root through unions, by any child, and differences, by the first
/// child. The smaller tree takes the place of that node. Where the words of the paper leave a choice:
/// - Common means equal up to the order of operands. Of a union, any of its operands together count as a subtree,
///   however the chain is stored: a | b | c and (c | b) - d have b | c in common.
/// - Only the larger tree needs a valid node, since the smaller one is put in whole. Where both have one, the larger
///   tree's is taken; where only the smaller has one, the two do not merge.
/// - Of several common subtrees of the same size, and of several valid nodes, the one nearest to the root is taken.
/// - A head that merges with none is passed over, and the next one becomes the head; passed-over trees are tried again
///   when others have merged. It ends when no two trees of the list merge.
/// - A tree that is simplified to the empty solid is left out, unless all are.
///
/// Only formulas are looked at: that the trees agree where they overlap is for the caller to verify, and trees that
/// stay apart (over disjoint primitives, or blocked by an intersection on the way to all they share) are for the
/// caller to join. Deterministic. Of long lists of trees that share primitives with few others: O(size x log^2 size);
/// else O(merges x (trees + size of the result x log size)); for each blocked pair O(size) more. A triggered run.stop
/// ends it between two merges: the trees are then as merged so far.
[[nodiscard]] MergeResult merge_trees(std::span<const CsgTree> trees, MergeOrder order = MergeOrder::paper,
                                      const RunContext& run = {});

/// Merges trees by what their primitives are to them, beyond the paper. A primitive that is wholly in the solid in the
/// tree of each clique that has it is united with all the rest, one that is wholly out of it is subtracted from all the
/// rest; both are then taken out of the trees, which are from now on about what is outside, and that uncovers others. A
/// tree without the primitive of its clique has something in its place, and that must be taken out first. What is
/// left over, such as a & b, is merged as by merge_trees(); then it is put together again, what went first outermost:
/// each primitive that was taken out appears once.
///
/// Right where each tree tells the truth about all of space near its primitives, and nothing is left over: of what is,
/// formulas are all that is looked at. Solids are taken to be bounded. `trees` and `cliques` belong together.
/// The result is one tree; in it, those of the core that are `blocked` are united as they are. Deterministic. O(size x
/// log size) for trees that each share primitives with few others.
[[nodiscard]] MergeResult merge_by_dominance(std::span<const CsgTree> trees, std::span<const Clique> cliques,
                                             const RunContext& run = {});

}  // namespace cloud2csg
