#include "cloud2csg/csg_tree.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/structurally_equal.hpp"
#include "tree/random_trees.hpp"

namespace cloud2csg {
namespace {

constexpr std::uint32_t k_deep = 50'000;

CsgTree a() {
  return CsgTree::leaf(0);
}
CsgTree b() {
  return CsgTree::leaf(1);
}
CsgTree c() {
  return CsgTree::leaf(2);
}

/// a0 - (a1 | (a2 - (a3 | ...))): as deep as it has inner nodes.
CsgTree right_leaning(std::uint32_t leaves) {
  std::vector<CsgNode> nodes;
  for (std::uint32_t p = 0; p < leaves; ++p) nodes.push_back(CsgNode::leaf(p % 3));
  for (std::uint32_t i = 1; i < leaves; ++i) {
    nodes.push_back(CsgNode::inner(i % 2 == 0 ? Operation::union_of : Operation::difference, 2 * i + 1));
  }
  return CsgTree(std::move(nodes));
}

TEST(CsgTree, DefaultIsTheEmptySolid) {
  EXPECT_EQ(CsgTree(), CsgTree::empty());
  EXPECT_EQ(CsgTree().size(), 1U);
  EXPECT_FALSE(contains(CsgTree::empty(), {}));
  EXPECT_TRUE(contains(CsgTree::full(), {}));
}

TEST(CsgTree, StoresChildrenBeforeTheirParent) {
  const CsgTree tree = subtract(unite(a(), b()), complement(c()));
  ASSERT_EQ(tree.size(), 6U);
  EXPECT_EQ(tree.nodes()[tree.root()].operation(), Operation::difference);
  EXPECT_EQ(tree.nodes()[tree.second_child(tree.root())].operation(), Operation::complement);
  EXPECT_EQ(CsgTree(tree.subtree(tree.first_child(tree.root()))), unite(a(), b()));
  EXPECT_EQ(CsgTree(tree.subtree(tree.second_child(tree.root()))), complement(c()));
}

TEST(CsgTree, LevelsAreThoseOfOperationsWithManyOperands) {
  EXPECT_EQ(levels(a()), 0U);
  EXPECT_EQ(levels(unite(unite(a(), b()), unite(b(), c()))), 1U);
  EXPECT_EQ(levels(intersect(a(), intersect(b(), c()))), 1U);
  EXPECT_EQ(levels(intersect(a(), unite(b(), c()))), 2U);
  EXPECT_EQ(levels(subtract(subtract(a(), b()), c())), 1U);
  EXPECT_EQ(levels(subtract(a(), unite(b(), c()))), 1U);
  EXPECT_EQ(levels(subtract(unite(a(), b()), c())), 2U);
  EXPECT_EQ(levels(subtract(a(), subtract(b(), c()))), 2U);
  EXPECT_EQ(levels(complement(complement(a()))), 2U);
}

TEST(CsgTree, MeasuresItself) {
  const CsgTree tree = subtract(unite(c(), a()), complement(intersect(c(), CsgTree::full())));
  EXPECT_EQ(depth(tree), 3U);
  EXPECT_EQ(depth(a()), 0U);
  EXPECT_EQ(levels(tree), 3U);
  EXPECT_EQ(leaf_count(tree), 3U);
  EXPECT_EQ(primitives_of(tree), (std::vector<PrimitiveIndex>{0, 2}));
}

TEST(CsgTree, RenumbersItsPrimitives) {
  const std::vector<PrimitiveIndex> new_index{7, 5, 6};
  EXPECT_EQ(renumber(subtract(a(), c()), new_index), subtract(CsgTree::leaf(7), CsgTree::leaf(6)));
}

TEST(CsgTree, UnitesAnyNumber) {
  EXPECT_EQ(unite_all({}), CsgTree::empty());
  EXPECT_EQ(unite_all(std::vector{a()}), a());
  EXPECT_EQ(unite_all(std::vector{a(), b(), c()}), unite(unite(a(), b()), c()));
}

TEST(CsgTree, ContainsFollowsTheOperations) {
  const CsgTree tree = unite(subtract(a(), b()), intersect(b(), complement(c())));
  for (int mask = 0; mask < 8; ++mask) {
    const bool in_a = (mask & 1) != 0;
    const bool in_b = (mask & 2) != 0;
    const bool in_c = (mask & 4) != 0;
    EXPECT_EQ(contains(tree, {in_a, in_b, in_c}), (in_a && !in_b) || (in_b && !in_c)) << mask;
  }
}

RC_GTEST_PROP(CsgTree, ReplaceSplicesAndMendsLengths, (const CsgTree& tree, const CsgTree& other)) {
  CsgTree changed = tree;
  const std::size_t at = *rc::gen::inRange<std::size_t>(0, tree.size());
  const std::size_t removed = tree.nodes()[at].length();
  changed.replace(at, other.nodes());
  RC_ASSERT(test::is_well_formed(changed));
  RC_ASSERT(changed.size() == tree.size() - removed + other.size());
  RC_ASSERT(CsgTree(changed.subtree(at + other.size() - removed)) == other);
  // Put back what was there.
  changed.replace(at + other.size() - removed, tree.subtree(at));
  RC_ASSERT(changed == tree);
}

TEST(CsgTree, CopesWithDeepTrees) {
  const CsgTree deep = right_leaning(k_deep);
  ASSERT_TRUE(test::is_well_formed(deep));
  EXPECT_EQ(depth(deep), k_deep - 1);
  EXPECT_EQ(leaf_count(deep), k_deep);
  EXPECT_EQ(structural_hashes(deep).size(), deep.size());
  EXPECT_TRUE(test::structurally_equal(deep, deep));
  const PrimitiveSet primitives = test::sphere_row(3);
  EXPECT_EQ(parse_tree(to_text(deep, primitives), primitives), deep);
  EXPECT_FALSE(contains(deep, {false, true, true}));
  CsgTree changed = deep;
  changed.replace(k_deep, a().nodes());
  EXPECT_TRUE(test::is_well_formed(changed));
  Points point(1);
  EXPECT_EQ(implicit_value(deep, primitives, point).size(), 1U);
  EXPECT_FALSE(to_graphviz({.primitives = primitives, .tree = deep}).empty());
}

TEST(StructuralHash, ForgetsTheOrderOfOperands) {
  EXPECT_TRUE(test::structurally_equal(unite(a(), unite(b(), c())), unite(unite(c(), a()), b())));
  EXPECT_TRUE(test::structurally_equal(intersect(a(), b()), intersect(b(), a())));
  EXPECT_TRUE(test::structurally_equal(subtract(subtract(a(), b()), c()), subtract(subtract(a(), c()), b())));
}

TEST(StructuralHash, TellsOtherTreesApart) {
  const std::vector<CsgTree> trees{a(),
                                   b(),
                                   CsgTree::empty(),
                                   CsgTree::full(),
                                   complement(a()),
                                   unite(a(), b()),
                                   intersect(a(), b()),
                                   subtract(a(), b()),
                                   subtract(b(), a()),
                                   unite(a(), a()),
                                   unite(a(), intersect(b(), c())),
                                   intersect(unite(a(), b()), c()),
                                   subtract(a(), subtract(b(), c())),
                                   subtract(subtract(a(), b()), c()),
                                   subtract(a(), unite(b(), c())),
                                   unite(subtract(a(), b()), c()),
                                   complement(complement(a()))};
  for (std::size_t i = 0; i < trees.size(); ++i) {
    for (std::size_t j = 0; j < trees.size(); ++j) {
      EXPECT_EQ(structural_hash(trees[i]) == structural_hash(trees[j]), i == j) << i << ' ' << j;
      EXPECT_EQ(test::structurally_equal(trees[i], trees[j]), i == j) << i << ' ' << j;
    }
  }
}

/// The same formula with operands swapped and chains rotated wherever `shuffle` says so.
CsgTree shuffled(const CsgTree& tree, const std::vector<bool>& shuffle) {
  std::vector<CsgTree> stack;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const CsgNode node = tree.nodes()[i];
    if (node.is_leaf()) {
      stack.emplace_back(tree.subtree(i));
      continue;
    }
    CsgTree second = stack.back();
    stack.pop_back();
    if (node.operation() == Operation::complement) {
      stack.push_back(complement(second));
      continue;
    }
    CsgTree first = stack.back();
    stack.pop_back();
    const bool changes = i < shuffle.size() && shuffle[i];
    const bool commutes = node.operation() != Operation::difference;
    const bool rotates = changes && first.nodes()[first.root()].operation() == node.operation();
    if (rotates && !commutes) {  // (x - y) - z becomes (x - z) - y
      const CsgTree x(first.subtree(first.first_child(first.root())));
      const CsgTree y(first.subtree(first.second_child(first.root())));
      stack.push_back(subtract(subtract(x, second), y));
      continue;
    }
    if (changes && commutes) std::swap(first, second);
    const auto join = node.operation() == Operation::union_of       ? unite
                      : node.operation() == Operation::intersection ? intersect
                                                                    : subtract;
    if (rotates) {  // here second is x op y: z op (x op y) becomes (z op x) op y
      const CsgTree x(second.subtree(second.first_child(second.root())));
      const CsgTree y(second.subtree(second.second_child(second.root())));
      stack.push_back(join(join(first, x), y));
    } else {
      stack.push_back(join(first, second));
    }
  }
  return stack.back();
}

RC_GTEST_PROP(StructuralHash, IsTheSameForShuffledTrees, (const CsgTree& tree, const std::vector<bool>& shuffle)) {
  const CsgTree other = shuffled(tree, shuffle);
  RC_ASSERT(other.size() == tree.size());
  RC_ASSERT(structural_hash(other) == structural_hash(tree));
  RC_ASSERT(test::structurally_equal(other, tree));
}

RC_GTEST_PROP(StructuralHash, AgreesWithExactEquality, ()) {
  const CsgTree first = *rc::gen::resize(8, test::any_tree(2));
  const CsgTree second = *rc::gen::resize(8, test::any_tree(2));
  RC_ASSERT((structural_hash(first) == structural_hash(second)) == test::structurally_equal(first, second));
}

RC_GTEST_PROP(StructuralHash, OfASubtreeIsThatOfItsCopy, (const CsgTree& tree)) {
  const std::vector<std::uint64_t> hashes = structural_hashes(tree);
  for (std::size_t i = 0; i < tree.size(); ++i) {
    RC_ASSERT(hashes[i] == structural_hash(CsgTree(tree.subtree(i))));
  }
}

TEST(Graphviz, DrawsABoxANodeAndAnEdgeAChild) {
  PrimitiveSet primitives = test::sphere_row(2);
  primitives[1].id = "a \"b\"";
  const std::string text = to_graphviz({.primitives = primitives, .tree = subtract(a(), complement(b()))});
  EXPECT_NE(text.find("n3 [label=\"difference\"]"), std::string::npos) << text;
  EXPECT_NE(text.find("n1 [label=\"a \\\"b\\\"\""), std::string::npos) << text;
  EXPECT_LT(text.find("n3 -> n0"), text.find("n3 -> n2")) << "the first child comes first";
  EXPECT_NE(text.find("n2 -> n1"), std::string::npos) << text;
  EXPECT_EQ(std::ranges::count(text, '>'), 3);
}

}  // namespace
}  // namespace cloud2csg
