#include "raw/detect/unexplained.hpp"

#include <gtest/gtest.h>

#include "detect/detected_parts.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_reach = 0.01;

/// The unit square at height 0, where every fourth normal points to the side. Then a square that is on its plane, but
/// apart from it, and points that are on the plane among others that are not. These two have such normals only.
WorkCloud partly_turned() {
  RandomStream random(3);
  PointCloud cloud;
  const auto add = [&](double least_x, double height, const Vector3d& normal) {
    cloud.positions.push_back({least_x + random.uniform(0, 1), random.uniform(0, 1), height});
    cloud.normals.push_back(normal);
  };
  for (int k = 0; k < 4000; ++k) {
    add(0, 0.002 * random.normal(), k % 4 == 0 ? Vector3d::UnitX() : Vector3d::UnitZ());
  }
  for (int k = 0; k < 1000; ++k) add(2, 0.002 * random.normal(), Vector3d::UnitX());
  for (int k = 0; k < 1000; ++k) add(4, 0.02 * (k % 5), Vector3d::UnitX());
  WorkCloud work = make_work_cloud(cloud);
  for (OrientedPoint& point : work.points) point.position = point.position * work.diagonal + work.middle;
  return work;
}

/// The plane of the squares with the points that have its normal.
GrownSurface plane_of(const WorkCloud& work) {
  GrownSurface plane{.surface = {.type = SurfaceType::plane}, .points = {}, .reach = k_reach};
  for (std::uint32_t i = 0; i < work.size(); ++i) {
    if (work.points[i].normal == Vector3d::UnitZ()) plane.points.push_back(i);
  }
  return plane;
}

std::size_t count_to_the_side(const WorkCloud& work) {
  return static_cast<std::size_t>(std::ranges::count(work.points, Vector3d(Vector3d::UnitX()), &OrientedPoint::normal));
}

TEST(TurnNormals, OfPointsOnASurfaceAmongItsPoints) {
  WorkCloud work = partly_turned();
  turn_normals(work, {plane_of(work)}, work.neighbours({}));
  for (const OrientedPoint& point : work.points) {
    EXPECT_EQ(point.normal == Vector3d::UnitZ(), point.position.x() < 1.5) << point.position.transpose();
  }
}

TEST(TurnNormals, NotWhereSurfacesMeet) {
  WorkCloud work = partly_turned();
  GrownSurface one = plane_of(work);
  GrownSurface two = one;
  two.surface.position.z() += k_reach / 10;
  const std::size_t before = count_to_the_side(work);
  turn_normals(work, {one, two}, work.neighbours({}));
  EXPECT_EQ(count_to_the_side(work), before);
}

TEST(TurnNormals, BackWhereNoSurfaceTookThePoint) {
  WorkCloud work = partly_turned();
  GrownSurface plane = plane_of(work);
  const std::size_t before = count_to_the_side(work);
  const std::vector<OwnNormal> turned = turn_normals(work, {plane}, work.neighbours({}));
  ASSERT_EQ(turned.size(), 1000U);
  for (std::size_t k = 0; k < 400; ++k) plane.points.push_back(turned[k].point);
  turn_back(work, turned, {plane});
  EXPECT_EQ(count_to_the_side(work), before - 400);
}

/// The neighbours of a point in a narrow bore are all around it, so estimated normals are arbitrary there.
TEST(TurnNormals, GiveANarrowBoreItsPoints) {
  constexpr double k_radius = 0.05;
  constexpr double k_error = 0.01;
  const test::Part part = test::without_others(
      {test::placed("block", Box{{1, 1, 4}}, {0, 0, 0}), test::placed("bore", Cylinder{k_radius, 5}, {0, 0, 0})});
  PointCloud cloud = test::cloud_of(part, k_error, 7500);
  RandomStream random(7);
  std::size_t in_bore = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d place = cloud.positions[i];
    if (place.head<2>().norm() > 2 * k_radius || std::abs(place.z()) > 1.95) continue;
    ++in_bore;
    const Vector3d error(random.normal(), random.normal(), random.normal());
    cloud.normals.set(i, (cloud.normals[i] + error).normalized());
  }
  ASSERT_GT(in_bore, 300U);
  const Detection detection = test::detect(cloud, k_error);
  const auto bore = std::ranges::find_if(
      detection.surfaces, [](const DetectedSurface& s) { return s.surface.type == SurfaceType::cylinder; });
  ASSERT_NE(bore, detection.surfaces.end());
  EXPECT_NEAR(bore->surface.radius, k_radius, 0.1 * k_radius);
  EXPECT_GT(bore->points.size(), in_bore * 8 / 10);
}

}  // namespace
}  // namespace cloud2csg
