#include "raw/solids/hidden_walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/base/random.hpp"

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

/// Only the upper mouth of the bore, and what else is there.
struct UpperMouth : Bore {
  UpperMouth() {
    cloud = {};
    add_rings(cloud, 1, 8, 10, {0, 0, 10.5});
    surfaces[0].points.resize(cloud.size());
  }

  /// The cloud's points from the first on are on a surface.
  void add_surface(const Surface& surface, std::size_t first) {
    DetectedSurface detected{.surface = surface, .points = {}};
    detected.points.resize(cloud.size() - first);
    std::iota(detected.points.begin(), detected.points.end(), static_cast<std::uint32_t>(first));
    surfaces.push_back(std::move(detected));
  }

  void add_material(double low) {
    const std::size_t first = cloud.size();
    add_rings(cloud, 1.8, low, 10, {});
    for (std::size_t i = first; i < cloud.size(); ++i) {
      const Vector3d out = -cloud.normals[i];
      cloud.normals.set(i, out);
      // One of four sensors around.
      const Vector3d way = std::abs(out.x()) > std::abs(out.y()) ? Vector3d::UnitX() : Vector3d::UnitY();
      cloud.sensor_positions.set(i, (out.dot(way) > 0 ? 12 : -12) * way);
    }
    add_surface({.type = SurfaceType::cylinder, .axis = Vector3d::UnitZ(), .radius = 1.8}, first);
  }

  /// The lower end of the bore.
  [[nodiscard]] double lowest() const {
    const std::vector<HiddenWall> walls = hidden_walls();
    const auto own = std::ranges::find(walls, 0U, &HiddenWall::surface);
    return own == walls.end() ? 8 : bounds_of(own->points.positions).min().z();
  }
};

TEST(HiddenWalls, GoThroughToTheEndOfTheMaterial) {
  UpperMouth tube;
  EXPECT_NEAR(tube.lowest(), 8, 0.2) << "nothing tells how far it goes";
  tube.add_material(-10);
  EXPECT_NEAR(tube.lowest(), -10, 0.2);
  const std::size_t first = tube.cloud.size();
  for (int k = -5; k <= 5; ++k) {
    tube.cloud.positions.push_back({0.1 * k, 0, -4});
    tube.cloud.normals.push_back({0, 0, -1});
    tube.cloud.sensor_positions.push_back({0, 0, -12});
  }
  tube.add_surface({.position = {0, 0, -4}, .axis = -Vector3d::UnitZ()}, first);
  EXPECT_NEAR(tube.lowest(), 8, 0.2) << "a face is in the way";
}

TEST(HiddenWalls, EndAtAFloorThatWasSeen) {
  for (const double height : {8.0, 5.0}) {
    UpperMouth blind;
    blind.add_material(-10);
    const std::size_t first = blind.cloud.size();
    for (double x = -0.6; x < 0.7; x += k_step) {
      for (double y = -0.6; y < 0.7; y += k_step) {
        blind.cloud.positions.push_back({x, y, height});
        blind.cloud.normals.push_back(Vector3d::UnitZ());
        blind.cloud.sensor_positions.push_back({0, 0, 10.5});
      }
    }
    blind.add_surface({.position = {0, 0, height}, .axis = Vector3d::UnitZ()}, first);
    EXPECT_GT(blind.lowest(), height - 0.2);
  }
}

TEST(HiddenWalls, EndWhereTheBoreGetsNarrower) {
  UpperMouth stepped;
  stepped.add_material(-10);
  const std::size_t first = stepped.cloud.size();
  add_rings(stepped.cloud, 0.6, 4, 5, {0, 0, 10.5});
  stepped.add_surface({.type = SurfaceType::cylinder, .axis = Vector3d::UnitZ(), .radius = 0.6, .concave = true},
                      first);
  EXPECT_NEAR(stepped.lowest(), 8, 0.2);
}

/// The lowest part of a hollow ball of radius 5, up to an angle around its middle, measured with noise through a narrow
/// opening in a plate above it.
Bore bowl(double angle) {
  Bore bowl;
  bowl.cloud = {};
  RandomStream random(1);
  for (double turn = 0.03; turn < angle; turn += k_step / 5) {
    const auto around = static_cast<int>(2 * std::numbers::pi * 5 * std::sin(turn) / k_step) + 1;
    for (int k = 0; k < around; ++k) {
      const double side = 2 * std::numbers::pi * k / around;
      const Vector3d out(std::sin(turn) * std::cos(side), std::sin(turn) * std::sin(side), -std::cos(turn));
      bowl.cloud.positions.push_back((5 + 0.02 * random.normal()) * out);
      bowl.cloud.normals.push_back(-out);
      bowl.cloud.sensor_positions.push_back({0, 0, 8});
    }
  }
  const std::size_t inside = bowl.cloud.size();
  for (double x = -9; x <= 9; x += k_step) {
    for (double y = -9; y <= 9; y += k_step) {
      if (std::hypot(x, y) < 1.2) continue;
      bowl.cloud.positions.push_back({x, y, 5.1});
      bowl.cloud.normals.push_back(Vector3d::UnitZ());
      bowl.cloud.sensor_positions.push_back({0, 0, 8});
    }
  }
  bowl.surfaces[0].surface = {.type = SurfaceType::sphere, .radius = 5, .concave = true};
  bowl.surfaces[0].points.resize(inside);
  std::iota(bowl.surfaces[0].points.begin(), bowl.surfaces[0].points.end(), 0U);
  return bowl;
}

TEST(HiddenWalls, AreOnlyThoseThatTheSeenPointsDetermine) {
  EXPECT_EQ(bowl(1).hidden_walls().size(), 1U);
  EXPECT_TRUE(bowl(0.15).hidden_walls().empty()) << "their ball may be twice as large";
}

}  // namespace
}  // namespace cloud2csg
