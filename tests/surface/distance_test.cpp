#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "cloud2csg/primitive.hpp"
#include "surface/patches.hpp"

namespace cloud2csg {
namespace {

TEST(SurfaceDistance, OfKnownSurfaces) {
  const Surface plane{.position = {0, 0, 2}, .axis = {0, 0, 1}};
  EXPECT_DOUBLE_EQ(signed_distance(plane, {5, 6, 1.5}), -0.5);
  const Surface sphere{.type = SurfaceType::sphere, .position = {1, 0, 0}, .radius = 2};
  EXPECT_DOUBLE_EQ(signed_distance(sphere, {1, 0, 3}), 1);
  const Surface cylinder{.type = SurfaceType::cylinder, .position = {0, 0, 7}, .axis = {0, 0, 1}, .radius = 2};
  EXPECT_DOUBLE_EQ(signed_distance(cylinder, {0, 1, -9}), -1);
  const Surface cone{
      .type = SurfaceType::cone, .position = {0, 0, 1}, .axis = {0, 0, 1}, .half_angle = std::numbers::pi / 4};
  EXPECT_DOUBLE_EQ(signed_distance(cone, {0, 0, 2}), -std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(signed_distance(cone, {0, 0, -2}), 3) << "behind the apex";
  const Surface torus{
      .type = SurfaceType::torus, .position = {0, 0, 0}, .axis = {0, 1, 0}, .radius = 3, .minor_radius = 1};
  EXPECT_DOUBLE_EQ(signed_distance(torus, {0, 0, 3}), -1);
  EXPECT_DOUBLE_EQ(signed_distance(torus, {0, 4, -3}), 3);
}

TEST(SurfaceDistance, HasANormalWhereThereIsNone) {
  for (const SurfaceType type : test::k_surface_types) {
    RandomStream random(4, static_cast<std::uint64_t>(type));
    const Surface surface = test::random_surface(type, random);
    const Eigen::Vector3d somewhere = surface.position + 0.4 * surface.axis;
    EXPECT_NEAR(normal(surface, surface.position).norm(), 1, 1e-9) << type;
    EXPECT_NEAR(normal(surface, somewhere).norm(), 1, 1e-9) << type;
  }
}

RC_GTEST_PROP(SurfaceDistance, TheFootOfAPointIsOnTheSurfaceAndItsNormalIsTheGradient, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint64_t>());
  for (const SurfaceType type : test::k_surface_types) {
    const Surface surface = test::random_surface(type, random, random.chance(0.5));
    const Eigen::Vector3d point = surface.position + test::random_within(2, random);
    const double distance = signed_distance(surface, point);
    const Eigen::Vector3d foot = point - distance * normal(surface, point);
    RC_ASSERT(std::abs(signed_distance(surface, foot)) < 1e-9);
    const Eigen::Vector3d step = 1e-6 * test::random_direction(random);
    const double slope = (signed_distance(surface, point + step) - signed_distance(surface, point - step)) / 2e-6;
    RC_ASSERT(std::abs(slope - 1e6 * step.dot(normal(surface, point))) < 1e-3);
  }
}

RC_GTEST_PROP(SurfaceDistance, AConcaveSurfaceHasTheOtherSide, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint64_t>());
  for (const SurfaceType type : test::k_surface_types) {
    Surface surface = test::random_surface(type, random);
    const Eigen::Vector3d point = test::random_within(2, random);
    const double convex = signed_distance(surface, point);
    surface.concave = true;
    RC_ASSERT(signed_distance(surface, point) == (type == SurfaceType::plane ? convex : -convex));
  }
}

TEST(SurfaceDistance, OfManyPointsIsThatOfEach) {
  RandomStream random(3);
  Points points;
  for (int i = 0; i < 20; ++i) points.push_back(test::random_within(2, random));
  for (const SurfaceType type : test::k_surface_types) {
    const Surface surface = test::random_surface(type, random, true);
    const std::vector<double> distances = signed_distance(surface, points);
    const Points normals = normal(surface, points);
    ASSERT_EQ(distances.size(), points.size());
    ASSERT_EQ(normals.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(distances[i], signed_distance(surface, points[i]));
      EXPECT_EQ(normals[i], normal(surface, points[i]));
    }
  }
}

/// The solids of the library have the same distances where their ends are far.
TEST(SurfaceDistance, IsThatOfTheSolid) {
  RandomStream random(8);
  Points points;
  for (int i = 0; i < 50; ++i) points.push_back(test::random_within(2, random));
  const auto expect_equal = [&](const Surface& surface, const Shape& shape, const Eigen::Vector3d& position) {
    const Primitive solid{.id = "solid", .shape = shape, .pose = pose_from_axis(position, surface.axis)};
    const std::vector<double> expected = signed_distance(solid, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(signed_distance(surface, points[i]), expected[i], 1e-9) << surface.type;
    }
  };
  for (const SurfaceType type : {SurfaceType::plane, SurfaceType::sphere, SurfaceType::torus}) {
    const Surface surface = test::random_surface(type, random);
    const Shape shape = type == SurfaceType::plane    ? Shape(HalfSpace{})
                        : type == SurfaceType::sphere ? Shape(Sphere{surface.radius})
                                                      : Shape(Torus{surface.radius, surface.minor_radius});
    expect_equal(surface, shape, surface.position);
  }
  const Surface cylinder = test::random_surface(SurfaceType::cylinder, random);
  expect_equal(cylinder, Cylinder{cylinder.radius, 100}, cylinder.position);
  const Surface cone = test::random_surface(SurfaceType::cone, random);
  expect_equal(cone, Cone{0, 100 * std::tan(cone.half_angle), 100}, cone.position + 50 * cone.axis);
}

}  // namespace
}  // namespace cloud2csg
