#include "raw/solids/hidden_walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_step = 0.15;

/// Points of rings around the z axis between two heights, seen by a sensor on the axis.
void add_rings(PointCloud& cloud, double radius, double low, double high, const Vector3d& sensor) {
  const auto around = static_cast<int>(2 * std::numbers::pi * radius / k_step);
  for (double z = low; z < high; z += k_step) {
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      const Vector3d out(std::cos(angle), std::sin(angle), 0);
      cloud.positions.push_back(radius * out + Vector3d(0, 0, z));
      cloud.normals.push_back(-out);
      cloud.sensor_positions.push_back(sensor);
    }
  }
}

/// Both mouths of a bore of radius 1 from z = -10 to 10, each seen as deep as 2 from straight above it.
struct Bore {
  PointCloud cloud;
  std::vector<DetectedSurface> surfaces;

  Bore() {
    add_rings(cloud, 1, 8, 10, {0, 0, 12});
    add_rings(cloud, 1, -10, -8, {0, 0, -12});
    DetectedSurface wall{
        .surface = {.type = SurfaceType::cylinder, .axis = Vector3d::UnitZ(), .radius = 1, .concave = true},
        .points = {}};
    wall.points.resize(cloud.size());
    std::iota(wall.points.begin(), wall.points.end(), 0U);
    surfaces.push_back(std::move(wall));
  }

  [[nodiscard]] std::vector<HiddenWall> hidden_walls() const {
    Scale scale;
    scale.diagonal = 20;
    scale.spacing = k_step;
    scale.noise = 0.001;
    return find_hidden_walls(cloud, surfaces, scale, cloud.size());
  }
};

TEST(HiddenWalls, JoinTheMouthsOfABore) {
  const Bore bore;
  const std::vector<HiddenWall> walls = bore.hidden_walls();
  ASSERT_EQ(walls.size(), 1U);
  EXPECT_EQ(walls[0].surface, 0U);
  EXPECT_NEAR(walls[0].area, 2 * std::numbers::pi * 16, 0.1 * 2 * std::numbers::pi * 16);
  for (std::size_t i = 0; i < walls[0].points.size(); ++i) {
    const Vector3d place = walls[0].points.positions[i];
    EXPECT_NEAR(place.head<2>().norm(), 1, 1e-9);
    EXPECT_LT(std::abs(place.z()), 8.2);
    const Vector3d way = walls[0].points.sensor_positions[i] - place;
    EXPECT_GT(way.dot(walls[0].points.normals[i]), 0.99 * way.norm());
  }
}

TEST(HiddenWalls, AreNoneOfASingleRing) {
  Bore bore;
  bore.cloud = {};
  for (int k = 0; k < 21; ++k) {
    const double angle = 2 * std::numbers::pi * k / 21;
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    bore.cloud.positions.push_back(out);
    bore.cloud.normals.push_back(-out);
    bore.cloud.sensor_positions.push_back({0, 0, 2});
  }
  bore.surfaces[0].points.resize(21);
  EXPECT_TRUE(bore.hidden_walls().empty());
}

TEST(HiddenWalls, AreNotWhereLinesOfSightPass) {
  Bore bore;
  // Behind both mouths is a wider space, the wall of which is seen through them.
  add_rings(bore.cloud, 3, -12, -1, {0, 0, 12});
  add_rings(bore.cloud, 3, 1, 12, {0, 0, -12});
  EXPECT_TRUE(bore.hidden_walls().empty());
}

}  // namespace
}  // namespace cloud2csg
