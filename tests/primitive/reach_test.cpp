#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "cloud2csg/primitive.hpp"
#include "primitive/random_primitives.hpp"

namespace cloud2csg {
namespace {

using testing::any_exact_shape;
using testing::any_polytope;
using testing::any_pose;
using testing::any_primitive;
using testing::integer;
using testing::real;

/// Grown by what rounding may do.
AlignedBox with_room(const AlignedBox& box) {
  return {box.min().array() - 1e-9, box.max().array() + 1e-9};
}

/// Nothing, a sliver, or as far as the solid is wide.
double any_distance() {
  const int kind = integer(0, 3);
  return kind == 0 ? 0.0 : kind == 1 ? real(0, 0.1) : real(0, 3);
}

/// Two faces that meet at a sharp angle, so that a point just beyond both is far from the tip.
Polytope any_wedge() {
  const double slope = real(3, 12);
  const Eigen::Vector3d up = Eigen::Vector3d(1, slope, 0).normalized();
  const Eigen::Vector3d down = Eigen::Vector3d(1, -slope, 0).normalized();
  return {.planes = {{up, 0.2}, {down, 0.2}, {{-1, 0, 0}, 0.5}, {{0, 0, 1}, 0.5}, {{0, 0, -1}, 0.5}}};
}

void expect_all_within(const Primitive& primitive, double distance, const Points& points) {
  const AlignedBox box = with_room(reach(primitive, distance));
  const std::vector<double> distances = signed_distance(primitive, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (distances[i] <= distance) RC_ASSERT(box.contains(points[i]));
  }
}

RC_GTEST_PROP(Reach, HoldsEveryPointThatIsNear, ()) {
  const Primitive primitive = any_primitive();
  const double distance = any_distance();
  expect_all_within(primitive, distance, testing::points_near(primitive, 128, 3 + distance));
}

/// Points on both sides of its faces: few that are anywhere come near the limit.
RC_GTEST_PROP(Reach, HoldsWhatIsNearEachFaceOfItsBox, ()) {
  const Primitive primitive{.id = "p", .shape = any_exact_shape(), .pose = any_pose()};
  RC_PRE(!std::holds_alternative<HalfSpace>(primitive.shape));
  const double distance = any_distance();
  const AlignedBox box = reach(primitive, distance);
  const AlignedBox wide(box.center() - 0.6 * box.sizes(), box.center() + 0.6 * box.sizes());
  Points points;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 60; ++k) {
      Eigen::Vector3d share(real(0, 1), real(0, 1), real(0, 1));
      share[axis] = integer(0, 2) == 0 ? real(0, 0.1) : real(0.9, 1);
      points.push_back(wide.min() + share.cwiseProduct(wide.sizes()));
    }
  }
  expect_all_within(primitive, distance, points);
}

/// The distance of a polytope grows slower than that to its tip: what is near reaches far beyond the bounds.
RC_GTEST_PROP(Reach, OfASharpWedgeHoldsWhatLiesBeyondItsTip, ()) {
  Primitive primitive{.id = "w", .shape = any_wedge(), .pose = any_pose()};
  if (integer(0, 3) == 0) primitive.displacement = Displacement{.frequency = real(0.5, 6)};
  const double distance = any_distance();
  Points points;
  for (int k = 0; k < 200; ++k) {
    points.push_back(primitive.pose.to_world({real(0, 30), real(-2, 2), real(-3, 3)}));
  }
  expect_all_within(primitive, distance, points);
}

TEST(Reach, OfASharpWedgeIsFarLongerThanTheDistance) {
  const Eigen::Vector3d up = Eigen::Vector3d(1, 10, 0).normalized();
  const Eigen::Vector3d down = Eigen::Vector3d(1, -10, 0).normalized();
  const Polytope wedge{{{up, 0.5}, {down, 0.5}, {{-1, 0, 0}, 1}, {{0, 0, 1}, 1}, {{0, 0, -1}, 1}}};
  const Primitive primitive{.id = "w", .shape = wedge};
  const Eigen::Vector3d beyond(10, 0, 0);
  ASSERT_LT(testing::distance_at(primitive, beyond), 0.6);
  ASSERT_GT(beyond.x(), bounds(primitive).max().x() + 4);
  EXPECT_TRUE(reach(primitive, 0.6).contains(beyond));
}

RC_GTEST_PROP(Reach, GrowsWithTheDistance, ()) {
  Primitive primitive = any_primitive();
  const double near = real(0, 1);
  const double far = near + real(0, 1);
  RC_ASSERT(with_room(reach(primitive, far)).contains(reach(primitive, near)));
  RC_ASSERT(with_room(reach(primitive, near)).contains(reach(primitive, 0)));
}

TEST(Reach, OfASphereIsItsBoxGrownByTheDistance) {
  const Primitive sphere{.id = "s", .shape = Sphere{2}, .pose = {.position = {1, 2, 3}}};
  const AlignedBox box = reach(sphere, 0.5);
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d(-1.5, -0.5, 0.5)));
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d(3.5, 4.5, 5.5)));
}

TEST(Reach, OfPolytopesIsFinite) {
  const Primitive primitive{
      .id = "p",
      .shape = Polytope{
          {{{1, 0, 0}, 1}, {{-1, 0, 0}, 1}, {{0, 1, 0}, 1}, {{0, -1, 0}, 1}, {{0, 0, 1}, 1}, {{0, 0, -1}, 1}}}};
  const AlignedBox box = reach(primitive, 0.25);
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d::Constant(1.25)));
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d::Constant(-1.25)));
}

TEST(Reach, OfWhatHasNoEndOrNoScaleIsInfinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const bool is_displaced : {false, true}) {
    for (const Shape& shape : {Shape(HalfSpace{}), Shape(testing::any_expression())}) {
      Primitive primitive{.id = "p", .shape = shape};
      if (is_displaced) primitive.displacement = Displacement{2};
      for (const double distance : {0.0, 1.0}) {
        EXPECT_EQ(reach(primitive, distance).max(), Eigen::Vector3d::Constant(infinity));
        EXPECT_EQ(reach(primitive, distance).min(), Eigen::Vector3d::Constant(-infinity));
      }
    }
  }
}

}  // namespace
}  // namespace cloud2csg
