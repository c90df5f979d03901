#include "cloud2csg/csg_tree.hpp"

#include <gtest/gtest.h>

namespace cloud2csg {
namespace {

CsgTree a() {
  return CsgTree::leaf(0);
}
CsgTree b() {
  return CsgTree::leaf(1);
}
CsgTree c() {
  return CsgTree::leaf(2);
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

}  // namespace
}  // namespace cloud2csg
