#include "core/fields/lipschitz.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <variant>

#include "support/any_solid.hpp"

namespace cloud2csg {
namespace {

Primitive any_primitive() {
  Primitive primitive{.id = "p", .shape = test::any_shape(), .pose = test::any_pose(1)};
  // From waves as long as the solid to some that are far shorter than the pairs of points are apart.
  if (*rc::gen::arbitrary<bool>())
    primitive.displacement = Displacement{.frequency = std::exp(test::any_double(-2, 5))};
  return primitive;
}

/// Pairs of places, from far apart to so near that their difference is a slope.
struct Pairs {
  Points from, to;
};

Pairs any_pairs(std::size_t count) {
  Pairs pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d place = test::any_vector(-3, 3);
    pairs.from.push_back(place);
    pairs.to.push_back(place + std::exp(test::any_double(-12, 1)) * test::any_vector(-1, 1));
  }
  return pairs;
}

void expect_no_steeper(const Pairs& pairs, const std::vector<double>& from, const std::vector<double>& to,
                       double steepest) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double way = (pairs.to[i] - pairs.from[i]).norm();
    RC_ASSERT(std::abs(to[i] - from[i]) <= steepest * (1 + 1e-12) * way + 1e-14 * (1 + std::abs(from[i])) * steepest);
  }
}

RC_GTEST_PROP(Lipschitz, NoPrimitiveIsSteeper, ()) {
  const Primitive primitive = any_primitive();
  const double steepest = lipschitz_bound(primitive);
  if (std::holds_alternative<Expression>(primitive.shape)) {
    RC_ASSERT(std::isinf(steepest));
    RC_ASSERT(std::isfinite(lipschitz_estimate(primitive)));
    return;
  }
  RC_ASSERT(lipschitz_estimate(primitive) == steepest);
  const Pairs pairs = any_pairs(30);
  expect_no_steeper(pairs, signed_distance(primitive, pairs.from), signed_distance(primitive, pairs.to), steepest);
}

RC_GTEST_PROP(Lipschitz, NoGradientIsLonger, ()) {
  const Primitive primitive = any_primitive();
  const Points gradients = gradient(primitive, any_pairs(30).from);
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    RC_ASSERT(gradients[i].norm() <= lipschitz_bound(primitive) * (1 + 1e-9));
  }
}

RC_GTEST_PROP(Lipschitz, NoTreeIsSteeper, ()) {
  const PrimitiveSet primitives{any_primitive(), any_primitive(), any_primitive()};
  const CsgTree tree = subtract(unite(CsgTree::leaf(0), complement(CsgTree::leaf(1))), CsgTree::leaf(2));
  const double steepest = lipschitz_bound(tree, primitives);
  if (std::isinf(steepest)) return;
  const Pairs pairs = any_pairs(30);
  expect_no_steeper(pairs, implicit_value(tree, primitives, pairs.from), implicit_value(tree, primitives, pairs.to),
                    steepest);
}

/// No smaller bound would do: where the waves of a plane rise along its normal, both slopes add up.
RC_GTEST_PROP(Lipschitz, APlaneWithWavesIsAsSteep, ()) {
  const double frequency = std::exp(test::any_double(-2, 5));
  const Primitive plane{
      .id = "p", .shape = HalfSpace{}, .pose = test::any_pose(1), .displacement = Displacement{.frequency = frequency}};
  const double crest = std::numbers::pi / 2 / frequency;
  Points place;
  place.push_back(plane.pose.to_world({crest, crest, 0}));
  RC_ASSERT(std::abs(gradient(plane, place)[0].norm() / lipschitz_bound(plane) - 1) < 1e-9);
}

TEST(Lipschitz, AnExpressionIsAsSteepAsItsSamplesAndMore) {
  const Expression steep{.distance = "5 * z - 1",
                         .bounds = AlignedBox(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1))};
  const Primitive primitive{.id = "e", .shape = steep};
  EXPECT_NEAR(lipschitz_estimate(primitive), 10, 1e-4);
  EXPECT_NEAR(lipschitz_estimate(CsgTree::leaf(0), {primitive}), 10, 1e-4);
  EXPECT_TRUE(std::isinf(lipschitz_bound(CsgTree::leaf(0), {primitive})));
}

TEST(Lipschitz, OfNothingIsOne) {
  EXPECT_EQ(lipschitz_bound(CsgTree::empty(), {}), 1);
}

}  // namespace
}  // namespace cloud2csg
