#include <gtest/gtest.h>

#include "cloud2csg/advanced/formula.hpp"

namespace cloud2csg {
namespace {

using Variables = std::vector<PrimitiveIndex>;

TEST(PartialFunction, KeepsItsRows) {
  PartialFunction function(3);
  function.add(Variables{}, false);
  function.add(Variables{0, 2}, true);
  EXPECT_EQ(function.rows(), 2U);
  EXPECT_TRUE(function.is_true(1, 0));
  EXPECT_FALSE(function.is_true(1, 1));
  EXPECT_TRUE(function.is_true(1, 2));
  EXPECT_FALSE(function.value(0));
  EXPECT_TRUE(function.value(1));
}

TEST(PartialFunction, EvaluatesEveryOperationAcrossWords) {
  constexpr std::size_t k_rows = 200;
  PartialFunction function(2);
  for (std::size_t row = 0; row < k_rows; ++row) {
    Variables inside;
    if (row % 2 == 1) inside.push_back(0);
    if (row % 3 == 1) inside.push_back(1);
    function.add(inside, row % 2 == 1 && row % 3 != 1);
  }
  const CsgTree a = CsgTree::leaf(0);
  const CsgTree b = CsgTree::leaf(1);
  EXPECT_TRUE(agrees(subtract(a, b), function));
  EXPECT_TRUE(agrees(intersect(a, complement(b)), function));
  EXPECT_TRUE(agrees(complement(unite(complement(a), b)), function));
  EXPECT_TRUE(agrees(unite(subtract(a, b), CsgTree::empty()), function));
  EXPECT_TRUE(agrees(intersect(CsgTree::full(), subtract(a, b)), function));
  EXPECT_FALSE(agrees(a, function));
  EXPECT_FALSE(agrees(unite(a, b), function));
}

}  // namespace
}  // namespace cloud2csg
