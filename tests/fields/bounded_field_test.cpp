#include "core/fields/bounded_field.hpp"

#include <gtest/gtest.h>

#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

/// A formula of a ball around the origin that is negative again far away, and is given the ball's box.
Primitive ball_with_an_echo() {
  const Expression formula{.distance = "min(sqrt(x^2 + y^2 + z^2) - 1, abs(x - 5) - 1)",
                           .bounds = AlignedBox(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1))};
  return test::placed("e", formula, {10, 0, 0});
}

TEST(BoundedField, EndsAnExpressionAtItsBounds) {
  const PrimitiveSet primitives{test::placed("box", Box{.size = {1, 1, 1}}, {0, 0, 0}), ball_with_an_echo()};
  const CsgTree tree = unite(complement(CsgTree::leaf(1)), subtract(CsgTree::leaf(0), CsgTree::leaf(1)));
  const Model field = bounded_field({.primitives = primitives, .tree = tree});
  ASSERT_EQ(field.primitives.size(), 3U);
  Points places;
  places.push_back({10, 0, 0});  // in the ball
  places.push_back({13, 0, 0});  // outside
  places.push_back({15, 0, 0});  // in what the formula says far away
  const std::vector<double> whole = implicit_value(tree, primitives, places);
  const std::vector<double> bounded = implicit_value(*field.tree, field.primitives, places);
  EXPECT_DOUBLE_EQ(whole[0], bounded[0]);
  EXPECT_LT(bounded[1], 0);
  EXPECT_GT(whole[2], 0);
  EXPECT_LT(bounded[2], 0) << "the complement of the ball";
}

TEST(BoundedField, LeavesOtherSolidsAsTheyAre) {
  const PrimitiveSet primitives{test::placed("box", Box{.size = {1, 1, 1}}, {0, 0, 0}), ball_with_an_echo()};
  const Model field = bounded_field({.primitives = primitives, .tree = complement(CsgTree::leaf(0))});
  EXPECT_EQ(field.tree, complement(CsgTree::leaf(0)));
  EXPECT_EQ(field.primitives.size(), 2U);
}

}  // namespace
}  // namespace cloud2csg
