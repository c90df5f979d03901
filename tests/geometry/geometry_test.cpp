#include "cloud2csg/geometry.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/place_text.hpp"

namespace cloud2csg {
namespace {

/// From low to high - 1, evenly: RapidCheck by itself begins near the low end.
int integer(int low, int high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high));
}

double real(double low, double high) {
  return low + (high - low) * 1e-6 * integer(0, 1'000'001);
}

Eigen::Vector3d vector_within(double size) {
  return {real(-size, size), real(-size, size), real(-size, size)};
}

Pose any_pose() {
  const double angle = real(-std::numbers::pi, std::numbers::pi);
  const Eigen::Vector3d axis = Eigen::Vector3d(real(0.1, 1), real(-1, 1), real(-1, 1)).normalized();
  return {.position = vector_within(3), .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis))};
}

RC_GTEST_PROP(Pose, ToLocalUndoesToWorld, ()) {
  const Pose pose = any_pose();
  const Eigen::Vector3d point = vector_within(10);
  RC_ASSERT((pose.to_local(pose.to_world(point)) - point).norm() < 1e-13);
  RC_ASSERT(std::abs((pose.to_world(point) - pose.to_world(-point)).norm() - 2 * point.norm()) < 1e-13);
}

RC_GTEST_PROP(Pose, ComposeAppliesTheInnerFirst, ()) {
  const Pose outer = any_pose();
  const Pose inner = any_pose();
  const Eigen::Vector3d point = vector_within(10);
  RC_ASSERT((compose(outer, inner).to_world(point) - outer.to_world(inner.to_world(point))).norm() < 1e-13);
}

RC_GTEST_PROP(Pose, FromAxisTurnsLocalZThere, ()) {
  const Eigen::Vector3d axis = vector_within(5);
  RC_PRE(axis.norm() > 1e-3);
  const Pose pose = pose_from_axis({1, 2, 3}, axis);
  RC_ASSERT((pose.to_world({0, 0, 1}) - Eigen::Vector3d(1, 2, 3) - axis.normalized()).norm() < 1e-12);
  RC_ASSERT(std::abs(pose.orientation.norm() - 1) < 1e-12);
}

TEST(Pose, FromAxisTakesTheOppositeOfZ) {
  const Pose pose = pose_from_axis(Eigen::Vector3d::Zero(), {0, 0, -2});
  EXPECT_NEAR(pose.to_world({0, 0, 1}).z(), -1, 1e-12);
  EXPECT_NEAR(pose.orientation.norm(), 1, 1e-12);
}

RC_GTEST_PROP(EnclosingBox, HoldsAllCornersAndTouchesOneOnEachSide, ()) {
  const OrientedBox box{.pose = any_pose(), .half_size = Eigen::Vector3d(real(0, 2), real(0, 2), real(0, 2))};
  AlignedBox corners;
  for (unsigned octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3d side((octant & 1U) != 0 ? 1 : -1, (octant & 2U) != 0 ? 1 : -1, (octant & 4U) != 0 ? 1 : -1);
    corners.extend(box.pose.to_world(side.cwiseProduct(box.half_size)));
  }
  const AlignedBox enclosing = enclosing_box(box);
  RC_ASSERT((enclosing.min() - corners.min()).norm() < 1e-13);
  RC_ASSERT((enclosing.max() - corners.max()).norm() < 1e-13);
}

TEST(EnclosingBox, IsInfiniteOnlyAlongAnInfiniteAxis) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()));
  const AlignedBox box =
      enclosing_box({.pose = {.position = {1, 2, 3}, .orientation = quarter}, .half_size = {0.5, 0.25, infinity}});
  EXPECT_EQ(box.max().y(), infinity);
  EXPECT_EQ(box.min().y(), -infinity);
  EXPECT_NEAR(box.min().x(), 0.5, 1e-12);
  EXPECT_NEAR(box.max().x(), 1.5, 1e-12);
  EXPECT_NEAR(box.min().z(), 2.75, 1e-12);
  EXPECT_NEAR(box.max().z(), 3.25, 1e-12);
}

TEST(BoundsOf, NoPointsAreEmpty) {
  EXPECT_TRUE(bounds_of(PointsView{}).isEmpty());
}

RC_GTEST_PROP(BoundsOf, IsTheSmallestBoxAroundThePoints, ()) {
  Points points;
  AlignedBox expected;
  const int count = integer(1, 20);
  for (int i = 0; i < count; ++i) {
    points.push_back(vector_within(4));
    expected.extend(points[static_cast<std::size_t>(i)]);
  }
  const AlignedBox box = bounds_of(points);
  RC_ASSERT(box.min() == expected.min());
  RC_ASSERT(box.max() == expected.max());
}

TEST(Points, SubviewIsARangeOfThePoints) {
  Points points(5);
  for (std::size_t i = 0; i < points.size(); ++i) points.set(i, Eigen::Vector3d::Constant(static_cast<double>(i)));
  const PointsView middle = points.view().subview(1, 3);
  ASSERT_EQ(middle.size(), 3U);
  EXPECT_EQ(middle[0], Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(middle[2], Eigen::Vector3d(3, 3, 3));
}

TEST(PlaceText, IsAsFineAsWhatItIsIn) {
  EXPECT_EQ(place_text({1.25, -0.5, 3}, 10), "(1.25, -0.5, 3)");
  EXPECT_EQ(place_text({1.23456, 0, -0.00001}, 10), "(1.235, 0, 0)");
  EXPECT_EQ(place_text({1000001.2345, 2e6, -1e6}, 10), "(1000001.235, 2000000, -1000000)");
  EXPECT_EQ(place_text({123456, 7, 0.4}, 1e6), "(123456, 7, 0)");
  EXPECT_EQ(place_text({1.5e-5, 0, 0}, 1e-4), "(0.000015, 0, 0)");
  EXPECT_EQ(place_text({1, 2, 3}, 0), "(1, 2, 3)");
}

}  // namespace
}  // namespace cloud2csg
