#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "tree/random_trees.hpp"

namespace cloud2csg {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// A grid on which many points are equally far from several spheres of test::sphere_row().
Points grid(int per_side) {
  Points points;
  for (int x = 0; x < per_side; ++x) {
    for (int y = 0; y < per_side; ++y) {
      for (int z = 0; z < 3; ++z) points.push_back({0.5 * x - 1, 0.5 * y - 1, 0.5 * z});
    }
  }
  return points;
}

/// The definition of the header, word for word: a tree on signed ranks at one point.
class SignedRanks {
 public:
  explicit SignedRanks(std::vector<double> distances) : distances_(std::move(distances)) {
    std::vector<std::size_t> order(distances_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [this](std::size_t p) { return std::abs(distances_[p]); });
    ranks_.resize(order.size());
    for (std::size_t place = 0; place < order.size(); ++place) ranks_[order[place]] = static_cast<int>(place) + 1;
  }

  [[nodiscard]] int evaluate(const CsgTree& tree) const {
    std::vector<int> stack;
    const int beyond = static_cast<int>(ranks_.size()) + 1;
    for (const CsgNode node : tree.nodes()) {
      if (arity(node.operation()) == 2) {
        const int b = stack.back();
        stack.pop_back();
        int& a = stack.back();
        if (node.operation() == Operation::union_of) a = std::min(a, b);
        if (node.operation() == Operation::intersection) a = std::max(a, b);
        if (node.operation() == Operation::difference) a = std::max(a, -b);
      } else if (node.operation() == Operation::complement) {
        stack.back() *= -1;
      } else if (node.operation() == Operation::primitive) {
        stack.push_back((distances_[node.primitive()] < 0 ? -1 : 1) * ranks_[node.primitive()]);
      } else {
        stack.push_back(node.operation() == Operation::empty ? beyond : -beyond);
      }
    }
    return stack.back();
  }

  /// The primitive of this signed rank; none for a constant.
  [[nodiscard]] std::size_t primitive(int signed_rank) const {
    return static_cast<std::size_t>(std::ranges::find(ranks_, std::abs(signed_rank)) - ranks_.begin());
  }
  /// Whether +f or -f has this signed rank.
  [[nodiscard]] double sign(int signed_rank) const {
    const bool is_inside = distances_[primitive(signed_rank)] < 0;
    return (signed_rank < 0) == is_inside ? 1.0 : -1.0;
  }

 private:
  std::vector<double> distances_;
  std::vector<int> ranks_;
};

TEST(ImplicitValue, IsMinMaxAndNegation) {
  const PrimitiveSet primitives = test::sphere_row(2);
  Points point;
  point.push_back({-0.5, 0, 0});  // distances -0.5 and 0.5
  const CsgTree a = CsgTree::leaf(0);
  const CsgTree b = CsgTree::leaf(1);
  const auto value = [&](const CsgTree& tree) { return implicit_value(tree, primitives, point).front(); };
  EXPECT_DOUBLE_EQ(value(a), -0.5);
  EXPECT_DOUBLE_EQ(value(unite(a, b)), -0.5);
  EXPECT_DOUBLE_EQ(value(intersect(a, b)), 0.5);
  EXPECT_DOUBLE_EQ(value(subtract(a, b)), -0.5);
  EXPECT_DOUBLE_EQ(value(subtract(b, a)), 0.5);
  EXPECT_DOUBLE_EQ(value(complement(a)), 0.5);
  EXPECT_EQ(value(CsgTree::empty()), k_infinity);
  EXPECT_EQ(value(CsgTree::full()), -k_infinity);
}

TEST(ImplicitValue, OfNoPointsIsNothing) {
  EXPECT_TRUE(implicit_value(CsgTree::leaf(0), test::sphere_row(1), Points()).empty());
  EXPECT_TRUE(implicit_gradient(CsgTree::leaf(0), test::sphere_row(1), Points()).empty());
}

RC_GTEST_PROP(ImplicitValue, AgreesWithMembership, (const CsgTree& tree)) {
  const PrimitiveSet primitives = test::sphere_row(6);
  const Points points = grid(8);
  const std::vector<double> values = implicit_value(tree, primitives, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<bool> inside;
    for (const Primitive& primitive : primitives) {
      inside.push_back((points[i] - primitive.pose.position).norm() < 1.0);
    }
    if (values[i] != 0) RC_ASSERT((values[i] < 0) == contains(tree, inside));
  }
}

RC_GTEST_PROP(ImplicitGradient, IsThatOfThePrimitiveOfTheSignedRank, (const CsgTree& tree)) {
  const PrimitiveSet primitives = test::sphere_row(6);
  const Points points = grid(7);
  std::vector<std::vector<double>> distances;
  std::vector<Points> gradients;
  for (const Primitive& primitive : primitives) {
    distances.push_back(signed_distance(primitive, points));
    gradients.push_back(gradient(primitive, points));
  }
  const std::vector<double> values = implicit_value(tree, primitives, points);
  const Points result = implicit_gradient(tree, primitives, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<double> here;
    for (const std::vector<double>& column : distances) here.push_back(column[i]);
    const SignedRanks ranks(here);
    const int rank = ranks.evaluate(tree);
    const std::size_t primitive = ranks.primitive(rank);
    if (primitive == primitives.size()) {
      RC_ASSERT(result[i] == Eigen::Vector3d(0, 0, 0));
      RC_ASSERT(std::abs(values[i]) == k_infinity);
    } else {
      RC_ASSERT(values[i] == ranks.sign(rank) * here[primitive]);
      RC_ASSERT(result[i] == Eigen::Vector3d(ranks.sign(rank) * gradients[primitive][i]));
    }
  }
}

TEST(ImplicitGradient, ResolvesTiesAlikeInEveryShapeOfTheTree) {
  const PrimitiveSet primitives = test::sphere_row(3);
  Points point;
  point.push_back({1, 5, 0});  // as far from p0 as from p2
  const CsgTree left = unite(CsgTree::leaf(0), CsgTree::leaf(2));
  const CsgTree right = unite(CsgTree::leaf(2), CsgTree::leaf(0));
  EXPECT_EQ(implicit_gradient(left, primitives, point)[0], gradient(primitives[0], point)[0]);
  EXPECT_EQ(implicit_gradient(right, primitives, point)[0], gradient(primitives[0], point)[0]);
}

TEST(ImplicitValue, IsTheSameInBlocksAsPointByPoint) {
  const PrimitiveSet primitives = test::sphere_row(4);
  const CsgTree tree =
      subtract(unite(CsgTree::leaf(3), CsgTree::leaf(1)), intersect(CsgTree::leaf(0), CsgTree::leaf(2)));
  const Points points = grid(30);  // more than one block
  const std::vector<double> values = implicit_value(tree, primitives, points);
  const Points gradients = implicit_gradient(tree, primitives, points);
  for (std::size_t i = 0; i < points.size(); i += 97) {
    const PointsView one = points.view().subview(i, 1);
    EXPECT_EQ(values[i], implicit_value(tree, primitives, one)[0]);
    EXPECT_EQ(gradients[i], implicit_gradient(tree, primitives, one)[0]);
  }
}

}  // namespace
}  // namespace cloud2csg
