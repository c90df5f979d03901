#include <gtest/gtest.h>

#include "bench/experiment/scaling.hpp"

namespace cloud2csg::test {
namespace {

constexpr double k_offset = 0.02;

TEST(Disagreement, IsNoneBetweenEqualSolids) {
  for (const Family family : all_families()) {
    const Model model = make_family(family, {.primitives = 60});
    EXPECT_EQ(disagreement(*model.tree, *model.tree, model.primitives, k_offset, 1).share, 0);
    const CsgTree same = complement(complement(*model.tree));
    EXPECT_EQ(disagreement(*model.tree, same, model.primitives, k_offset, 1).share, 0);
  }
}

TEST(Disagreement, IsFoundWhereAPrimitiveIsMissing) {
  const Model model = make_family(Family::chain, {.primitives = 50});
  // A primitive in place of another: around two of fifty, and their neighbours to a lesser degree.
  CsgTree wrong = *model.tree;
  const std::vector<CsgNode> other{CsgNode::leaf(30)};
  wrong.replace(0, other);
  const Disagreement found = disagreement(wrong, *model.tree, model.primitives, k_offset, 1);
  EXPECT_GE(found.primitives, 1U);
  EXPECT_LE(found.primitives, 5U);
  EXPECT_GT(found.share, 0.002);
  EXPECT_LT(found.share, 0.1);
}

TEST(Disagreement, IsLargeForTheEmptySolid) {
  const Model model = make_family(Family::grid, {.primitives = 50});
  const Disagreement found = disagreement(CsgTree::empty(), *model.tree, model.primitives, k_offset, 1);
  EXPECT_EQ(found.primitives, 50U);
  EXPECT_GT(found.share, 0.4);
}

TEST(Disagreement, DoesNotDependOnThreads) {
  const Model model = make_family(Family::random, {.primitives = 50});
  const CsgTree other = complement(*model.tree);
  EXPECT_EQ(disagreement(other, *model.tree, model.primitives, k_offset, 1, {.threads = 1}).share,
            disagreement(other, *model.tree, model.primitives, k_offset, 1, {.threads = 4}).share);
}

}  // namespace
}  // namespace cloud2csg::test
