#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "tree/random_trees.hpp"

namespace cloud2csg {
namespace {

std::string simplified(const std::string& text) {
  return to_text(simplify(parse_tree(text, test::letters())), test::letters());
}

struct Rule {
  std::string from, to;
};

class SimplifyRule : public testing::TestWithParam<Rule> {};

TEST_P(SimplifyRule, IsApplied) {
  EXPECT_EQ(simplified(GetParam().from), GetParam().to);
}

INSTANTIATE_TEST_SUITE_P(Idempotence, SimplifyRule,
                         testing::Values(Rule{"a | a", "a"}, Rule{"a & a", "a"}, Rule{"a | b | a", "a | b"},
                                         Rule{"(a - b) | c | (a - b)", "(a - b) | c"}, Rule{"a - b - b", "a - b"}));
INSTANTIATE_TEST_SUITE_P(Absorption, SimplifyRule,
                         testing::Values(Rule{"a | (a & b)", "a"}, Rule{"a & (a | b)", "a"},
                                         Rule{"a & (b | (c | a))", "a"}, Rule{"a | b & (c & a)", "a"},
                                         Rule{"(a | b) & (b | c | a)", "a | b"}, Rule{"(a & b) | (b & c & a)", "a & b"},
                                         Rule{"a | (a - b)", "a"}, Rule{"(a - b) | (a - c - b)", "a - b"},
                                         Rule{"d & ((a - b) | e) | (a - b)", "(d & e) | (a - b)"}));
INSTANTIATE_TEST_SUITE_P(Complements, SimplifyRule,
                         testing::Values(Rule{"~~a", "a"}, Rule{"~(~a | ~b)", "a & b"}, Rule{"~a & ~b", "~(a | b)"},
                                         Rule{"a & ~b", "a - b"}, Rule{"~b & a", "a - b"}, Rule{"a - ~b", "a & b"},
                                         Rule{"~a - b", "~(a | b)"}, Rule{"c & (a | ~b)", "c - (b - a)"},
                                         Rule{"~(a - b)", "~(a - b)"}, Rule{"a | ~b", "~(b - a)"}));
INSTANTIATE_TEST_SUITE_P(Constants, SimplifyRule,
                         testing::Values(Rule{"a | empty", "a"}, Rule{"a & empty", "empty"}, Rule{"a - empty", "a"},
                                         Rule{"empty - a", "empty"}, Rule{"a | full", "full"}, Rule{"a & full", "a"},
                                         Rule{"a - full", "empty"}, Rule{"full - a", "~a"}, Rule{"~empty", "full"},
                                         Rule{"~full", "empty"}, Rule{"a & ~a", "empty"}, Rule{"a | ~a", "full"},
                                         Rule{"a - a", "empty"}, Rule{"(a | b) - (b | a)", "empty"},
                                         Rule{"(a & b | c) | ~(c | b & a)", "full"}, Rule{"b | (a & (c - c))", "b"}));
INSTANTIATE_TEST_SUITE_P(Differences, SimplifyRule,
                         testing::Values(Rule{"a - b - c", "a - (b | c)"}, Rule{"a - (a - b)", "a & b"},
                                         Rule{"a - (b - a)", "a"}, Rule{"(a - b) | b", "a | b"},
                                         Rule{"(a | b) - b", "a - b"}, Rule{"(a - b) & c", "(a & c) - b"},
                                         Rule{"(a - b) & b", "empty"}, Rule{"(a - b) - (a - c)", "(a & c) - b"},
                                         Rule{"a - (b - c) - c", "a - (b | c)"}));
INSTANTIATE_TEST_SUITE_P(CommonFactors, SimplifyRule,
                         testing::Values(Rule{"a & b | a & c", "a & (b | c)"}, Rule{"(a | b) & (a | c)", "a | (b & c)"},
                                         Rule{"(a - b) | (c - b)", "(a | c) - b"},
                                         Rule{"(a - b) & (a - c)", "a - (b | c)"}, Rule{"(a & b) | (a - b)", "a"},
                                         Rule{"(a | b) - (c - a)", "a | (b - c)"},
                                         Rule{"a & b & c | a & b & d", "a & b & (c | d)"},
                                         Rule{"e - (a & b | a & c)", "e - (a & (b | c))"}));

RC_GTEST_PROP(Simplify, NeverChangesMembership, ()) {
  const CsgTree tree = *test::any_tree(6);
  RC_ASSERT(test::truth_table(simplify(tree), 6) == test::truth_table(tree, 6));
}

RC_GTEST_PROP(Simplify, NeverChangesMembershipOfManyPrimitives, ()) {
  const CsgTree tree = *rc::gen::resize(250, test::any_tree(11));
  RC_ASSERT(test::truth_table(simplify(tree), 11) == test::truth_table(tree, 11));
}

RC_GTEST_PROP(Simplify, NeverGrowsAndIsWellFormed, ()) {
  const CsgTree tree = *rc::gen::resize(200, test::any_tree(*rc::gen::inRange<std::uint32_t>(2, 12)));
  const CsgTree simple = simplify(tree);
  RC_ASSERT(test::is_well_formed(simple));
  RC_ASSERT(simple.size() <= tree.size());
  const std::size_t leaves = leaf_count(simple);
  if (leaves > 0) RC_ASSERT(simple.size() == 2 * leaves - 1 || simple.size() == 2 * leaves);
  if (leaves == 0) RC_ASSERT(simple.size() == 1U);
}

RC_GTEST_PROP(Simplify, ASecondTimeChangesNothing, ()) {
  const CsgTree once = simplify(*rc::gen::resize(200, test::any_tree(*rc::gen::inRange<std::uint32_t>(2, 12))));
  RC_ASSERT(simplify(once) == once);
}

RC_GTEST_PROP(Simplify, LeavesFewOfTwoPrimitives, ()) {
  // All 16 solids of two primitives, but for the two symmetric differences, need each primitive once.
  const CsgTree simple = simplify(*test::any_tree(2));
  RC_ASSERT(leaf_count(simple) <= 4U);
}

TEST(Simplify, CopesWithPlainUnionsOfManyLeaves) {
  std::vector<CsgTree> leaves;
  for (PrimitiveIndex p = 0; p < 10'000; ++p) leaves.push_back(CsgTree::leaf(p % 5'000));
  const CsgTree simple = simplify(unite_all(leaves));
  EXPECT_EQ(simple, unite_all(std::span(leaves).first(5'000)));
}

TEST(Simplify, CopesWithDeepTrees) {
  std::vector<CsgNode> nodes;
  constexpr std::uint32_t k_leaves = 50'000;
  for (std::uint32_t p = 0; p < k_leaves; ++p) nodes.push_back(CsgNode::leaf(p));
  for (std::uint32_t i = 1; i < k_leaves; ++i) {
    nodes.push_back(CsgNode::inner(i % 2 == 0 ? Operation::union_of : Operation::difference, 2 * i + 1));
  }
  const CsgTree deep{nodes};
  ASSERT_TRUE(test::is_well_formed(deep));
  const CsgTree simple = simplify(deep);
  EXPECT_TRUE(test::is_well_formed(simple));
  EXPECT_EQ(leaf_count(simple), k_leaves);
  EXPECT_EQ(simplify(simple), simple);
}

TEST(Simplify, CopesWithManyComplements) {
  CsgTree tree = CsgTree::leaf(3);
  std::vector<CsgNode> nodes(tree.nodes().begin(), tree.nodes().end());
  for (std::uint32_t i = 0; i < 100'001; ++i) nodes.push_back(CsgNode::inner(Operation::complement, i + 2));
  EXPECT_EQ(simplify(CsgTree{nodes}), complement(tree));
}

}  // namespace
}  // namespace cloud2csg
