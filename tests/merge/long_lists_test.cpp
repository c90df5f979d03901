#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <stop_token>
#include <vector>

#include "cloud2csg/advanced/merge.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/base/random.hpp"
#include "tree/random_trees.hpp"

/// Lists that are so long that they are first made short by pairs.
namespace cloud2csg {
namespace {

/// Leaves 0, 2, 4... in a row, each overlapping the next; 1, 3, 5... are cut out of the one before.
constexpr PrimitiveIndex row(PrimitiveIndex i) {
  return 2 * i;
}
constexpr PrimitiveIndex cut(PrimitiveIndex i) {
  return 2 * i + 1;
}

std::vector<CsgTree> chain(PrimitiveIndex links) {
  std::vector<CsgTree> trees;
  for (PrimitiveIndex i = 0; i < links; ++i) trees.push_back(unite(CsgTree::leaf(row(i)), CsgTree::leaf(row(i + 1))));
  return trees;
}

std::vector<CsgTree> chain_with_cuts(PrimitiveIndex links) {
  std::vector<CsgTree> trees;
  for (PrimitiveIndex i = 0; i < links; ++i) {
    trees.push_back(subtract(CsgTree::leaf(row(i)), CsgTree::leaf(cut(i))));
    trees.push_back(unite(CsgTree::leaf(row(i)), CsgTree::leaf(row(i + 1))));
  }
  return trees;
}

void shuffle(std::vector<CsgTree>& trees, std::uint64_t seed) {
  RandomStream random(seed);
  for (std::size_t k = trees.size(); k > 1; --k) std::swap(trees[k - 1], trees[random.below(k)]);
}

bool contains_at(const CsgTree& tree, PrimitiveIndex links, std::initializer_list<PrimitiveIndex> places) {
  std::vector<bool> inside(2 * std::size_t{links} + 2, false);
  for (const PrimitiveIndex p : places) inside[p] = true;
  return contains(tree, inside);
}

class LongLists : public testing::TestWithParam<MergeOrder> {};

INSTANTIATE_TEST_SUITE_P(BothOrders, LongLists, testing::Values(MergeOrder::paper, MergeOrder::largest_common_subtree));

/// Short, at the limit, and long.
constexpr std::array<PrimitiveIndex, 6> k_links{5, 64, 65, 66, 200, 500};

TEST_P(LongLists, ChainsOfUnionsBecomeOne) {
  for (const PrimitiveIndex links : k_links) {
    std::vector<CsgTree> trees = chain(links);
    for (const std::uint64_t seed : {0U, 1U}) {
      if (seed > 0) shuffle(trees, seed);
      const MergeResult result = merge_trees(trees, GetParam());
      ASSERT_EQ(result.trees.size(), 1U) << links;
      EXPECT_EQ(result.merges, links - 1U);
      EXPECT_EQ(result.blocked, 0U);
      EXPECT_EQ(result.trees[0].size(), 2U * links + 1);
      EXPECT_EQ(primitives_of(result.trees[0]).size(), links + 1U);
    }
  }
}

TEST_P(LongLists, CutsStayInPlace) {
  for (const PrimitiveIndex links : k_links) {
    std::vector<CsgTree> trees = chain_with_cuts(links);
    for (const std::uint64_t seed : {0U, 1U, 2U}) {
      if (seed > 0) shuffle(trees, seed);
      const MergeResult result = merge_trees(trees, GetParam());
      ASSERT_EQ(result.trees.size(), 1U) << links;
      EXPECT_EQ(result.merges, trees.size() - 1);
      const CsgTree& tree = result.trees[0];
      EXPECT_EQ(leaf_count(tree), 2U * links + 1);
      for (PrimitiveIndex i = 0; i < links; ++i) {
        EXPECT_TRUE(contains_at(tree, links, {row(i)}));
        EXPECT_TRUE(contains_at(tree, links, {row(i), row(i + 1)}));
        EXPECT_FALSE(contains_at(tree, links, {row(i), cut(i)}));
        EXPECT_FALSE(contains_at(tree, links, {cut(i)}));
      }
    }
  }
}

TEST_P(LongLists, ThatDoNotMergeStayAsTheyAre) {
  std::vector<CsgTree> trees;
  for (PrimitiveIndex i = 0; i < 100; ++i) trees.push_back(intersect(CsgTree::leaf(i), CsgTree::leaf(i + 1)));
  const MergeResult result = merge_trees(trees, GetParam());
  EXPECT_EQ(result.trees, trees);
  EXPECT_EQ(result.merges, 0U);
  EXPECT_EQ(result.blocked, 99U);
}

TEST_P(LongLists, OfSeveralModelsBecomeOneEach) {
  std::vector<CsgTree> trees;
  for (PrimitiveIndex i = 0; i < 100; ++i) {
    for (const PrimitiveIndex model : {0U, 1U, 2U}) {
      trees.push_back(unite(CsgTree::leaf(1000 * model + i), CsgTree::leaf(1000 * model + i + 1)));
    }
  }
  const MergeResult result = merge_trees(trees, GetParam());
  ASSERT_EQ(result.trees.size(), 3U);
  for (PrimitiveIndex model = 0; model < 3; ++model) {
    EXPECT_EQ(primitives_of(result.trees[model]).front(), 1000 * model);
    EXPECT_EQ(leaf_count(result.trees[model]), 101U);
  }
  EXPECT_EQ(result.blocked, 0U);
}

TEST_P(LongLists, StopAtOnce) {
  std::stop_source stop;
  stop.request_stop();
  const std::vector<CsgTree> trees = chain(100);
  const MergeResult result = merge_trees(trees, GetParam(), {.stop = stop.get_token()});
  EXPECT_EQ(result.trees, trees);
  EXPECT_EQ(result.merges, 0U);
}

/// As for short lists: nothing is lost, what is left does not merge, and it is the same each time.
RC_GTEST_PROP(LongListsProperty, MergeAsFarAsTheyCan, (std::uint64_t seed)) {
  RandomStream random(seed);
  const MergeOrder order = random.chance(0.5) ? MergeOrder::paper : MergeOrder::largest_common_subtree;
  std::vector<CsgTree> trees;
  while (trees.size() < 120) {
    const CsgTree a = CsgTree::leaf(random.below(60));
    const CsgTree b = CsgTree::leaf(random.below(60));
    const std::uint32_t kind = random.below(5);
    const CsgTree tree = kind == 0 ? intersect(a, b) : kind == 1 ? subtract(a, b) : unite(a, b);
    if (simplify(tree) != CsgTree::empty()) trees.push_back(tree);
  }
  const MergeResult result = merge_trees(trees, order);
  RC_ASSERT(result.trees.size() + result.merges == trees.size());
  for (const CsgTree& tree : result.trees) {
    RC_ASSERT(test::is_well_formed(tree));
    RC_ASSERT(simplify(tree) == tree);
  }
  RC_ASSERT(merge_trees(trees, order).trees == result.trees);
  RC_ASSERT(merge_trees(result.trees, order).merges == 0U);
}

}  // namespace
}  // namespace cloud2csg
