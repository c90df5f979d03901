#include "cloud2csg/advanced/restrict.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "tree/random_trees.hpp"

namespace cloud2csg::test {
namespace {

constexpr std::uint32_t k_primitives = 6;

std::vector<PrimitiveIndex> members(unsigned mask) {
  std::vector<PrimitiveIndex> kept;
  for (PrimitiveIndex p = 0; p < k_primitives; ++p) {
    if (((mask >> p) & 1U) != 0) kept.push_back(p);
  }
  return kept;
}

bool holds_constant(const CsgTree& tree) {
  return std::ranges::any_of(tree.nodes(), [](CsgNode node) {
    return node.operation() == Operation::empty || node.operation() == Operation::full;
  });
}

RC_GTEST_PROP(RestrictTo, ContainsWhatTheTreeDoesWhereTheOthersAreNot, (const CsgTree& tree)) {
  const auto mask = *rc::gen::inRange<unsigned>(0, 1U << k_primitives);
  const CsgTree restricted = restrict_to(tree, members(mask));
  RC_ASSERT(is_well_formed(restricted));
  const std::vector<bool> truth = truth_table(tree, k_primitives);
  const std::vector<bool> table = truth_table(restricted, k_primitives);
  for (unsigned inside = 0; inside < truth.size(); ++inside) RC_ASSERT(table[inside] == truth[inside & mask]);
}

RC_GTEST_PROP(RestrictTo, LeavesNoConstantsAndOnlyWhatIsKept, (const CsgTree& tree)) {
  const std::vector<PrimitiveIndex> kept = members(*rc::gen::inRange<unsigned>(0, 1U << k_primitives));
  const CsgTree restricted = restrict_to(tree, kept);
  RC_ASSERT(restricted.size() <= tree.size());
  RC_ASSERT(restricted.size() == 1 || !holds_constant(restricted));
  for (const PrimitiveIndex p : primitives_of(restricted)) RC_ASSERT(std::ranges::count(kept, p) == 1);
  for (std::size_t i = 1; i < restricted.size(); ++i) {
    const auto is_complement = [&](std::size_t n) {
      return restricted.nodes()[n].operation() == Operation::complement;
    };
    RC_ASSERT(!(is_complement(i) && is_complement(i - 1)));
  }
}

RC_GTEST_PROP(TreeRestriction, GivesTheSameTrees, (const CsgTree& tree)) {
  const TreeRestriction restriction(tree);
  for (unsigned mask = 0; mask < 1U << k_primitives; ++mask) {
    const std::vector<PrimitiveIndex> kept = members(mask);
    RC_ASSERT(restriction.restrict_to(kept) == restrict_to(tree, kept));
  }
}

TEST(RestrictTo, TakesTheKeptInAnyOrderAndAnyNumber) {
  const CsgTree tree = subtract(unite(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2));
  const CsgTree expected = subtract(CsgTree::leaf(1), CsgTree::leaf(2));
  const std::vector<PrimitiveIndex> kept{2, 1, 2, 17};
  EXPECT_EQ(restrict_to(tree, kept), expected);
  EXPECT_EQ(TreeRestriction(tree).restrict_to(kept), expected);
}

TEST(RestrictTo, FoldsWhatBecomesConstant) {
  const CsgTree a = CsgTree::leaf(0);
  const CsgTree b = CsgTree::leaf(1);
  const std::vector<PrimitiveIndex> only_b{1};
  EXPECT_EQ(restrict_to(intersect(a, b), only_b), CsgTree::empty());
  EXPECT_EQ(restrict_to(unite(complement(a), b), only_b), CsgTree::full());
  EXPECT_EQ(restrict_to(subtract(complement(a), b), only_b), complement(b));
  EXPECT_EQ(restrict_to(complement(subtract(complement(a), b)), only_b), b);
  EXPECT_EQ(restrict_to(subtract(a, b), {}), CsgTree::empty());
}

TEST(TreeRestriction, ReachesDeepIntoALongChain) {
  std::vector<CsgTree> leaves;
  for (PrimitiveIndex p = 0; p < 20'000; ++p) leaves.push_back(CsgTree::leaf(p));
  const TreeRestriction restriction(unite_all(leaves));
  for (PrimitiveIndex p = 0; p + 1 < leaves.size(); ++p) {
    const std::vector<PrimitiveIndex> pair{p, p + 1};
    ASSERT_EQ(restriction.restrict_to(pair), unite(leaves[p], leaves[p + 1]));
  }
}

}  // namespace
}  // namespace cloud2csg::test
