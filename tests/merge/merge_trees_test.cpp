#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "cloud2csg/advanced/merge.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "tree/random_trees.hpp"

namespace cloud2csg {
namespace {

std::vector<CsgTree> parsed(const std::vector<std::string>& texts) {
  std::vector<CsgTree> trees;
  for (const std::string& text : texts) trees.push_back(parse_tree(text, test::letters()));
  return trees;
}

std::vector<std::string> merged(const std::vector<std::string>& texts, MergeOrder order = MergeOrder::paper) {
  std::vector<std::string> result;
  for (const CsgTree& tree : merge_trees(parsed(texts), order).trees) result.push_back(to_text(tree, test::letters()));
  return result;
}

using Texts = std::vector<std::string>;

class MergeTrees : public testing::TestWithParam<MergeOrder> {};

INSTANTIATE_TEST_SUITE_P(BothOrders, MergeTrees,
                         testing::Values(MergeOrder::paper, MergeOrder::largest_common_subtree));

TEST_P(MergeTrees, LeavesNoneAndOneAlone) {
  EXPECT_TRUE(merge_trees({}, GetParam()).trees.empty());
  const MergeResult result = merge_trees(parsed({"a - (b | b)"}), GetParam());
  EXPECT_EQ(result.trees, parsed({"a - b"}));
  EXPECT_EQ(result.merges, 0U);
}

TEST_P(MergeTrees, StopsWithTheTreesAsTheyAre) {
  std::stop_source stop;
  stop.request_stop();
  const std::vector<CsgTree> trees = parsed({"a | b", "b | c", "c | d"});
  const MergeResult result = merge_trees(trees, GetParam(), {.stop = stop.get_token()});
  EXPECT_EQ(result.trees, trees);
  EXPECT_EQ(result.merges, 0U);
}

TEST_P(MergeTrees, UnionsMergeAtWhatTheyShare) {
  EXPECT_EQ(merged({"a | b", "b | c"}, GetParam()), Texts{"a | b | c"});
  EXPECT_EQ(merged({"a | b", "b | c", "c | d"}, GetParam()), Texts{"a | b | c | d"});
  EXPECT_EQ(merge_trees(parsed({"a | b", "b | c", "c | d"}), GetParam()).merges, 2U);
}

TEST_P(MergeTrees, PutsTheSmallerIntoTheLarger) {
  EXPECT_EQ(merged({"a | b", "(b | c | d) - e"}, GetParam()), Texts{"(a | b | c | d) - e"});
  EXPECT_EQ(merged({"(b | c | d) - e", "a | b"}, GetParam()), Texts{"(a | b | c | d) - e"});
}

TEST_P(MergeTrees, OfEqualSizesTheFirstReceivesTheSecond) {
  EXPECT_EQ(merged({"a | b", "a - c"}, GetParam()), Texts{"(a - c) | b"});
  EXPECT_EQ(merged({"a - c", "a | b"}, GetParam()), Texts{"(a | b) - c"});
}

TEST_P(MergeTrees, FirstChildrenOfDifferencesAreValid) {
  EXPECT_EQ(merged({"((a - b) | c) - d", "a | e"}, GetParam()), Texts{"(((a | e) - b) | c) - d"});
}

TEST_P(MergeTrees, AnIntersectionOnTheWayBlocks) {
  const MergeResult result = merge_trees(parsed({"(a | b) & c", "a | d"}), GetParam());
  EXPECT_EQ(result.trees, parsed({"(a | b) & c", "a | d"}));
  EXPECT_EQ(result.merges, 0U);
  EXPECT_EQ(result.blocked, 1U);
}

TEST_P(MergeTrees, TheSubtractedSideIsNotValid) {
  EXPECT_EQ(merged({"a - (b | c)", "b | d"}, GetParam()), (Texts{"a - (b | c)", "b | d"}));
  EXPECT_EQ(merged({"a - b", "c - b"}, GetParam()), (Texts{"a - b", "c - b"}));
}

TEST_P(MergeTrees, ASmallerSubtreeServesWhereTheLargerIsBlocked) {
  // b | c is shared, but only under an intersection; d is shared at a valid place.
  EXPECT_EQ(merged({"((b | c) & a) | d", "(d | e) - (b | c)"}, GetParam()),
            Texts{"((b | c) & a) | ((d | e) - (b | c))"});
}

TEST_P(MergeTrees, WholeSubtreesGoBeforeTheirParts) {
  // At a - b, not at a: (a - b) | c with ((a - b) | d) - e.
  EXPECT_EQ(merged({"((a - b) | d) - e", "(a - b) | c"}, GetParam()), Texts{"((a - b) | c | d) - e"});
}

TEST_P(MergeTrees, PartsOfUnionsCountHoweverTheyAreStored) {
  // At b | c as a whole, so that e is cut out of both.
  EXPECT_EQ(merged({"(b | a | c) - d", "(c | b) - e"}, GetParam()), Texts{"(((c | b) - e) | a) - d"});
}

TEST_P(MergeTrees, DisjointTreesStayApart) {
  const MergeResult result = merge_trees(parsed({"a | b", "c | d", "b | e", "d | f"}), GetParam());
  EXPECT_EQ(result.trees, parsed({"a | b | e", "c | d | f"}));
  EXPECT_EQ(result.merges, 2U);
  EXPECT_EQ(result.blocked, 0U);
}

TEST_P(MergeTrees, TreesPassedOverAreTriedAgain) {
  // The first has no valid node for a, and is larger than the second; but not than what becomes of that.
  EXPECT_EQ(merged({"(a & b) - (c | d)", "a | e"}, GetParam()).size(), 2U);
  EXPECT_EQ(merged({"(a & b) - (c | d)", "a | e", "e | f | g | h"}, GetParam()),
            Texts{"((a & b) - (c | d)) | e | f | g | h"});
}

TEST_P(MergeTrees, EmptySolidsAreLeftOut) {
  EXPECT_EQ(merged({"a - a", "b | c", "empty"}, GetParam()), Texts{"b | c"});
  EXPECT_EQ(merged({"a - a", "empty"}, GetParam()), Texts{"empty"});
}

/// A plate of spheres in a grid: each square of four overlaps, as in the model M2.
std::vector<CsgTree> grid_of_squares(PrimitiveIndex rows, PrimitiveIndex columns) {
  std::vector<CsgTree> trees;
  for (PrimitiveIndex r = 0; r + 1 < rows; ++r) {
    for (PrimitiveIndex c = 0; c + 1 < columns; ++c) {
      const PrimitiveIndex corner = r * columns + c;
      trees.push_back(unite_all(std::vector{CsgTree::leaf(corner), CsgTree::leaf(corner + 1),
                                            CsgTree::leaf(corner + columns), CsgTree::leaf(corner + columns + 1)}));
    }
  }
  return trees;
}

TEST_P(MergeTrees, AGridOfSpheresBecomesOneUnion) {
  const MergeResult result = merge_trees(grid_of_squares(5, 4), GetParam());
  ASSERT_EQ(result.trees.size(), 1U);
  EXPECT_EQ(result.merges, 11U);
  EXPECT_EQ(result.trees[0].size(), 39U);
  EXPECT_EQ(primitives_of(result.trees[0]).size(), 20U);
}

TEST_P(MergeTrees, CopesWithAThousandTrees) {
  const MergeResult result = merge_trees(grid_of_squares(33, 33), GetParam());
  ASSERT_EQ(result.trees.size(), 1U);
  EXPECT_EQ(result.merges, 1023U);
  EXPECT_EQ(leaf_count(result.trees[0]), 33U * 33U);
}

RC_GTEST_PROP(MergeTreesProperty, NeverLosesATree, ()) {
  const auto order = *rc::gen::element(MergeOrder::paper, MergeOrder::largest_common_subtree);
  // Every primitive once in a tree and none subtracted or cut: nothing may vanish.
  const auto sets = *rc::gen::container<std::vector<std::vector<PrimitiveIndex>>>(
      rc::gen::nonEmpty(rc::gen::container<std::vector<PrimitiveIndex>>(rc::gen::inRange<PrimitiveIndex>(0, 20))));
  std::vector<CsgTree> trees;
  for (const std::vector<PrimitiveIndex>& set : sets) {
    std::vector<CsgTree> leaves;
    for (const PrimitiveIndex p : set) leaves.push_back(CsgTree::leaf(p));
    trees.push_back(unite_all(leaves));
  }
  const MergeResult result = merge_trees(trees, order);
  RC_ASSERT(result.trees.size() + result.merges == trees.size());
  RC_ASSERT(result.blocked == 0U);
  // Unions that share a primitive always merge, so that each primitive is in one tree, once.
  const CsgTree all = unite_all(result.trees);
  RC_ASSERT(primitives_of(all) == primitives_of(unite_all(trees)));
  RC_ASSERT(leaf_count(all) == primitives_of(all).size());
}

RC_GTEST_PROP(MergeTreesProperty, KeepsCountAndSimpleTrees, (const std::vector<CsgTree>& trees)) {
  const auto order = *rc::gen::element(MergeOrder::paper, MergeOrder::largest_common_subtree);
  const MergeResult result = merge_trees(trees, order);
  const auto not_empty = static_cast<std::size_t>(
      std::ranges::count_if(trees, [](const CsgTree& tree) { return simplify(tree) != CsgTree::empty(); }));
  const std::size_t expected = not_empty == 0 ? std::min<std::size_t>(trees.size(), 1) : not_empty;
  RC_ASSERT(result.trees.size() + result.merges == expected);
  for (const CsgTree& tree : result.trees) {
    RC_ASSERT(test::is_well_formed(tree));
    RC_ASSERT(simplify(tree) == tree);
  }
  const MergeResult again = merge_trees(trees, order);
  RC_ASSERT(again.trees == result.trees);
  // What is left does not merge any more.
  RC_ASSERT(merge_trees(result.trees, order).merges == 0U);
}

}  // namespace
}  // namespace cloud2csg
