#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloud2csg/primitive.hpp"
#include "primitive/random_primitives.hpp"

namespace cloud2csg {
namespace {

using testing::any_convex_primitive;
using testing::any_pose;
using testing::any_primitive;
using testing::distance_at;
using testing::real;
using testing::unit_vector;

AlignedBox inflated(const AlignedBox& box, double margin) {
  return {box.min().array() - margin, box.max().array() + margin};
}

RC_GTEST_PROP(Bounds, HoldEveryPointInside, ()) {
  const Primitive primitive = any_primitive();
  const Points points = testing::points_near(primitive, 64, 2.5);
  const std::vector<double> distance = signed_distance(primitive, points);
  const AlignedBox aligned = inflated(bounds(primitive), 1e-12);
  const OrientedBox oriented = oriented_bounds(primitive);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (distance[i] > 0) continue;
    RC_ASSERT(aligned.contains(points[i]));
    const Eigen::Vector3d local = oriented.pose.to_local(points[i]);
    RC_ASSERT((local.cwiseAbs().array() <= oriented.half_size.array() + 1e-12).all());
  }
}

RC_GTEST_PROP(Bounds, OfConvexSolidsTouchThemOnEachSide, ()) {
  const Primitive primitive = any_convex_primitive();
  const AlignedBox box = bounds(primitive);
  const OrientedBox oriented = oriented_bounds(primitive);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
    RC_ASSERT(std::abs(support(primitive, unit)[axis] - box.max()[axis]) < 1e-9);
    RC_ASSERT(std::abs(support(primitive, -unit)[axis] - box.min()[axis]) < 1e-9);
    const Eigen::Vector3d direction = oriented.pose.orientation * unit;
    const double reach = oriented.pose.to_local(support(primitive, direction))[axis];
    RC_ASSERT(std::abs(reach - oriented.half_size[axis]) < 1e-9);
  }
}

RC_GTEST_PROP(Bounds, OfATorusTouchItOnEachSide, ()) {
  const double major = real(0.5, 2);
  const Torus torus{.major_radius = major, .minor_radius = major * real(0.1, 1)};
  const Primitive primitive{.id = "t", .shape = torus, .pose = any_pose()};
  const AlignedBox box = bounds(primitive);
  for (int axis = 0; axis < 3; ++axis) {
    // The farthest point of a torus: from the farthest point of its core circle on by the minor radius.
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
    Eigen::Vector3d across = primitive.pose.orientation.conjugate() * unit;
    across.z() = 0;
    if (across.norm() < 1e-12) across = Eigen::Vector3d::UnitX();  // seen along its axis, all are as far
    const Eigen::Vector3d core = primitive.pose.to_world(major * across.normalized());
    const Eigen::Vector3d farthest = core + torus.minor_radius * unit;
    RC_ASSERT(std::abs(distance_at(primitive, farthest)) < 1e-9);
    RC_ASSERT(std::abs(farthest[axis] - box.max()[axis]) < 1e-9);
  }
}

TEST(Bounds, OfADisplacedBoxAreNearThoseSeen) {
  // The box of the paper's model M1: its lobes reach 0.856 in every coordinate, where bounds grown by one say 1.3.
  const Primitive primitive{.id = "Box_0", .shape = Box{{0.6, 0.6, 0.6}}, .displacement = Displacement{2}};
  AlignedBox seen;
  Points grid;
  constexpr int k_steps = 80;
  for (int x = 0; x < k_steps; ++x) {
    for (int y = 0; y < k_steps; ++y) {
      for (int z = 0; z < k_steps; ++z) grid.push_back(-1.3 + 2.6 * Eigen::Array3d(x, y, z) / (k_steps - 1));
    }
  }
  const std::vector<double> distance = signed_distance(primitive, grid);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (distance[i] <= 0) seen.extend(grid[i]);
  }
  const AlignedBox box = bounds(primitive);
  EXPECT_TRUE(box.contains(seen));
  EXPECT_LT((box.sizes() - seen.sizes()).maxCoeff(), 0.1);
  EXPECT_LT((2 * oriented_bounds(primitive).half_size - seen.sizes()).maxCoeff(), 0.1);
}

TEST(Bounds, OfADisplacedWedgeHoldItsTip) {
  // Where the faces meet at a sharp angle the solid can grow by more than the displacement's amplitude.
  const Eigen::Vector3d up = Eigen::Vector3d(1, 10, 0).normalized();
  const Eigen::Vector3d down = Eigen::Vector3d(1, -10, 0).normalized();
  Polytope wedge{{{up, 0.5}, {down, 0.5}, {{-1, 0, 0}, 1}, {{0, 0, 1}, 1}, {{0, 0, -1}, 1}}};
  const Primitive primitive{.id = "w", .shape = wedge, .displacement = Displacement{6}};
  const AlignedBox box = bounds(primitive);
  Points grid;
  for (int x = 0; x < 60; ++x) {
    for (int y = 0; y < 20; ++y) {
      for (int z = 0; z < 10; ++z) grid.push_back({4 + 0.15 * x, -1 + 0.1 * y, -1 + 0.2 * z});
    }
  }
  const std::vector<double> distance = signed_distance(primitive, grid);
  int beyond = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (distance[i] > 0) continue;
    EXPECT_TRUE(box.contains(grid[i])) << grid[i].transpose();
    beyond += grid[i].x() > 5.03 + 1 ? 1 : 0;
  }
  EXPECT_GT(beyond, 0);
}

TEST(Bounds, OfAHalfSpaceAreInfinite) {
  const Primitive primitive{.id = "h", .shape = HalfSpace{}, .displacement = Displacement{2}};
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(bounds(primitive).max(), Eigen::Vector3d::Constant(infinity));
  EXPECT_EQ(bounds(primitive).min(), Eigen::Vector3d::Constant(-infinity));
  EXPECT_EQ(oriented_bounds(primitive).half_size, Eigen::Vector3d::Constant(infinity));
}

RC_GTEST_PROP(Support, IsOnTheSolidAndNothingIsFarther, ()) {
  const Primitive primitive = any_convex_primitive();
  RC_ASSERT(is_convex(primitive));
  const Eigen::Vector3d direction = real(0.1, 10) * unit_vector();
  const Eigen::Vector3d farthest = support(primitive, direction);
  RC_ASSERT(std::abs(distance_at(primitive, farthest)) < 1e-9);
  const Points points = testing::points_near(primitive, 64, 2.5);
  const std::vector<double> distance = signed_distance(primitive, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (distance[i] <= 0) RC_ASSERT(direction.dot(points[i] - farthest) <= 1e-9);
  }
}

TEST(Support, TakesDirectionsAlongTheAxes) {
  const Primitive cylinder{.id = "c", .shape = Cylinder{1, 4}};
  EXPECT_NEAR(support(cylinder, {0, 0, -3}).z(), -2, 1e-15);
  const Primitive cone{.id = "k", .shape = Cone{2, 0, 4}};
  EXPECT_EQ(support(cone, {0, 0, 1}), Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(support(cone, {1, 0, 0}), Eigen::Vector3d(2, 0, -2));
}

TEST(IsConvex, NeedsAConvexShapeWithoutDisplacement) {
  EXPECT_TRUE(is_convex({.id = "b", .shape = Box{{1, 1, 1}}}));
  EXPECT_TRUE(is_convex({.id = "h", .shape = HalfSpace{}}));
  EXPECT_FALSE(is_convex({.id = "t", .shape = Torus{2, 1}}));
  EXPECT_FALSE(is_convex({.id = "e", .shape = testing::any_expression()}));
  EXPECT_FALSE(is_convex({.id = "b", .shape = Box{{1, 1, 1}}, .displacement = Displacement{1}}));
}

TEST(Corners, OfACubeAreEight) {
  Polytope cube;
  for (int axis = 0; axis < 3; ++axis) {
    cube.planes.push_back({Eigen::Vector3d::Unit(axis), 1});
    cube.planes.push_back({-Eigen::Vector3d::Unit(axis), 1});
  }
  cube.planes.push_back({Eigen::Vector3d::Unit(0), 1});  // twice the same face
  cube.planes.push_back({Eigen::Vector3d::Unit(1), 5});  // one that touches nothing
  const std::vector<Eigen::Vector3d> points = corners(cube);
  EXPECT_EQ(points.size(), 8U);
  for (const Eigen::Vector3d& point : points) EXPECT_EQ(point.cwiseAbs(), Eigen::Vector3d(1, 1, 1));
}

TEST(Corners, OfAnOctahedronAreSixThoughFourPlanesMeetInEach) {
  Polytope octahedron;
  for (unsigned octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3d side((octant & 1U) != 0 ? 1 : -1, (octant & 2U) != 0 ? 1 : -1, (octant & 4U) != 0 ? 1 : -1);
    octahedron.planes.push_back({side.normalized(), 1});
  }
  EXPECT_EQ(corners(octahedron).size(), 6U);
}

RC_GTEST_PROP(Corners, AreOnThreePlanesAndInsideAllOthers, ()) {
  const Polytope polytope = testing::any_polytope();
  for (const Eigen::Vector3d& point : corners(polytope)) {
    const auto on_plane = [&](const Plane& plane) { return std::abs(plane.normal.dot(point) - plane.offset) < 1e-8; };
    RC_ASSERT(std::ranges::count_if(polytope.planes, on_plane) >= 3);
    RC_ASSERT(std::ranges::all_of(polytope.planes,
                                  [&](const Plane& plane) { return plane.normal.dot(point) < plane.offset + 1e-8; }));
  }
}

}  // namespace
}  // namespace cloud2csg
