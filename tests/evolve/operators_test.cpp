#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "paper/evolve/genetic_algorithm.hpp"
#include "tree/random_trees.hpp"

namespace cloud2csg {
namespace {

std::size_t leaves_of(const CsgTree& tree, PrimitiveIndex primitive) {
  return static_cast<std::size_t>(std::ranges::count_if(
      tree.nodes(), [primitive](const CsgNode& node) { return node == CsgNode::leaf(primitive); }));
}

/// The same tree with every leaf renamed.
CsgTree all_leaves(const CsgTree& tree, PrimitiveIndex primitive) {
  const std::vector<PrimitiveIndex> names(16, primitive);
  return renumber(tree, names);
}

bool is_below(const CsgTree& tree, int height) {
  return test::is_well_formed(tree) && depth(tree) <= static_cast<std::size_t>(std::max(height, 0));
}

RC_GTEST_PROP(RandomTree, KeepsHeightAndPrimitives, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(10);
  const int height = static_cast<int>(random.below(9)) - 1;
  const CsgTree tree = random_tree(primitives, height, random);
  RC_ASSERT(is_below(tree, height));
  for (const PrimitiveIndex p : primitives_of(tree)) RC_ASSERT(p < primitives);
}

TEST(RandomTree, HasEveryOperationAndPrimitiveAndReachesTheHeight) {
  RandomStream random(1);
  std::array<std::size_t, 8> seen{};
  std::array<std::size_t, 3> leaves{};
  std::size_t deepest = 0;
  std::size_t single = 0;
  constexpr int k_trees = 2000;
  for (int i = 0; i < k_trees; ++i) {
    const CsgTree tree = random_tree(3, 4, random);
    deepest = std::max(deepest, depth(tree));
    single += tree.size() == 1 ? 1 : 0;
    for (const CsgNode& node : tree.nodes()) ++seen[static_cast<std::size_t>(node.operation())];
    for (PrimitiveIndex p = 0; p < 3; ++p) leaves[p] += leaves_of(tree, p);
  }
  EXPECT_EQ(deepest, 4U);
  EXPECT_NEAR(static_cast<double>(single), 0.5 * k_trees, 0.05 * k_trees);
  EXPECT_EQ(seen[static_cast<std::size_t>(Operation::empty)], 0U);
  EXPECT_EQ(seen[static_cast<std::size_t>(Operation::full)], 0U);
  const auto unions = static_cast<double>(seen[static_cast<std::size_t>(Operation::union_of)]);
  for (const Operation operation : {Operation::intersection, Operation::difference, Operation::complement}) {
    EXPECT_NEAR(static_cast<double>(seen[static_cast<std::size_t>(operation)]), unions, 0.2 * unions);
  }
  EXPECT_NEAR(static_cast<double>(leaves[0]), static_cast<double>(leaves[2]), 0.2 * static_cast<double>(leaves[0]));
}

RC_GTEST_PROP(Crossover, ChildrenKeepTheHeightLimit, (std::uint64_t seed)) {
  RandomStream random(seed);
  const int limit = 1 + static_cast<int>(random.below(8));
  const CsgTree a = random_tree(5, limit, random);
  const CsgTree b = random_tree(5, limit, random);
  const Children children = crossover(a, b, limit, random);
  RC_ASSERT(is_below(children.first, limit));
  RC_ASSERT(is_below(children.second, limit));
}

/// The mother has only primitive 0, the father only primitive 1: what one child gained, the other has lost.
RC_GTEST_PROP(Crossover, EachChildGetsWhatTheOtherGivesAway, (std::uint64_t seed)) {
  RandomStream random(seed);
  const CsgTree mother = all_leaves(random_tree(5, 6, random), 0);
  const CsgTree father = all_leaves(random_tree(5, 6, random), 1);
  const auto [first, second] = crossover(mother, father, 100, random);
  RC_ASSERT(test::is_well_formed(first));
  RC_ASSERT(test::is_well_formed(second));
  RC_ASSERT(first.size() + second.size() == mother.size() + father.size());
  RC_ASSERT(leaves_of(first, 0) + leaves_of(second, 0) == leaf_count(mother));
  RC_ASSERT(leaves_of(first, 1) + leaves_of(second, 1) == leaf_count(father));
  RC_ASSERT(leaves_of(first, 1) > 0U);
  RC_ASSERT(leaves_of(second, 0) > 0U);
}

TEST(Crossover, AChildThatWouldBeTooHighIsItsOwnParent) {
  const CsgTree low = CsgTree::leaf(0);
  const CsgTree high = unite(unite(CsgTree::leaf(1), CsgTree::leaf(1)), CsgTree::leaf(1));
  const CsgTree combed = unite(CsgTree::leaf(0), unite(CsgTree::leaf(0), CsgTree::leaf(0)));
  RandomStream random(4);
  bool some_refused = false;
  for (int i = 0; i < 200; ++i) {
    const Children children = crossover(combed, high, 2, random);
    EXPECT_LE(depth(children.first), 2U);
    EXPECT_LE(depth(children.second), 2U);
    some_refused = some_refused || children.first == combed || children.second == high;
    if (children.first == combed) {
      EXPECT_EQ(leaves_of(children.first, 1), 0U);
    }
    const Children swapped = crossover(low, high, 2, random);
    EXPECT_GE(leaves_of(swapped.second, 0), 1U);  // a leaf fits everywhere
  }
  EXPECT_TRUE(some_refused);
}

/// Chains to the left and to the right, balanced trees, complements: wherever a subtree is put in, its level counts.
CsgTree chain(int height, bool to_the_left) {
  CsgTree tree = CsgTree::leaf(0);
  for (int level = 0; level < height; ++level) {
    tree = to_the_left ? subtract(tree, CsgTree::leaf(0)) : subtract(CsgTree::leaf(0), tree);
  }
  return tree;
}

RC_GTEST_PROP(MutateSubtree, KeepsTheHeightLimit, (std::uint64_t seed)) {
  RandomStream random(seed);
  const int limit = 1 + static_cast<int>(random.below(8));
  const CsgTree tree = random_tree(4, limit, random);
  const CsgTree mutant = mutate_subtree(tree, 4, limit, random);
  RC_ASSERT(is_below(mutant, limit));
  for (const PrimitiveIndex p : primitives_of(mutant)) RC_ASSERT(p < 4U);
}

class MutateChain : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(ToEitherSide, MutateChain, ::testing::Bool());

TEST_P(MutateChain, KeepsTheHeightLimit) {
  RandomStream random(8);
  for (int height = 1; height <= 8; ++height) {
    const CsgTree tree = chain(height, GetParam());
    for (int i = 0; i < 300; ++i) EXPECT_TRUE(is_below(mutate_subtree(tree, 2, height, random), height)) << height;
  }
}

/// A new subtree may use all of the height that its place leaves: leaves of the old tree show that it is not the root.
TEST_P(MutateChain, ReachesTheHeightLimitBelowTheRoot) {
  RandomStream random(9);
  const CsgTree tree = all_leaves(chain(2, GetParam()), 7);
  std::size_t full_height = 0;
  for (int i = 0; i < 2000; ++i) {
    const CsgTree mutant = mutate_subtree(tree, 2, 4, random);
    full_height += depth(mutant) == 4 && leaves_of(mutant, 7) == 2 ? 1 : 0;
  }
  EXPECT_GT(full_height, 0U);
}

TEST(MutateSubtree, ReplacesOneSubtreeAndKeepsTheRest) {
  RandomStream random(10);
  const CsgTree tree = all_leaves(unite(unite(CsgTree::leaf(0), CsgTree::leaf(0)), CsgTree::leaf(0)), 9);
  std::array<bool, 4> old_leaves_left{};
  for (int i = 0; i < 500; ++i) old_leaves_left[leaves_of(mutate_subtree(tree, 3, 5, random), 9)] = true;
  // The root, the left pair, one leaf of it or the right leaf: never is everything kept.
  EXPECT_EQ(old_leaves_left, (std::array<bool, 4>{true, true, true, false}));
}

}  // namespace
}  // namespace cloud2csg
