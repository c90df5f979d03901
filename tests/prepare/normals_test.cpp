#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "cloud2csg/advanced/prepare.hpp"
#include "prepare/clouds.hpp"
#include "raw/prepare/orientation.hpp"
#include "raw/prepare/patches.hpp"
#include "support/known_solids.hpp"
#include "support/warnings.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

double orientation_found(const PointCloud& cloud) {
  return rightly_oriented(estimate_normals(without_normals(cloud), estimate_scale(cloud)).normals, cloud.normals);
}

TEST(Agreement, HoldsOnPlanesAroundEdgesAndAcrossWalls) {
  const Vector3d up = Vector3d::UnitZ();
  EXPECT_DOUBLE_EQ(agreement({1, 2, 0}, up, up), 1.0);
  EXPECT_NEAR(agreement({0.5, 0, -0.5}, up, Vector3d::UnitX()), 1.0, 1e-12);  // convex edge
  EXPECT_NEAR(agreement({-0.5, 0, 0.5}, up, Vector3d::UnitX()), 1.0, 1e-12);  // concave edge
  EXPECT_DOUBLE_EQ(agreement({0, 0, -0.1}, up, -up), 1.0);                    // thin wall
  EXPECT_DOUBLE_EQ(agreement({0, 0, -0.1}, up, up), -1.0);
}

TEST(SignedSets, KeepSignsAcrossJoins) {
  SignedSets sets(6);
  sets.join(0, 1, true);
  sets.join(2, 3, false);
  sets.join(1, 3, true);
  sets.join(4, 5, true);
  const auto sign = [&](std::uint32_t i) { return sets.find(i).is_flipped; };
  EXPECT_EQ(sets.find(0).root, sets.find(2).root);
  EXPECT_NE(sets.find(0).root, sets.find(4).root);
  EXPECT_NE(sign(0), sign(1));
  EXPECT_EQ(sign(2), sign(3));
  EXPECT_NE(sign(1), sign(3));
  EXPECT_NE(sign(4), sign(5));
}

TEST(EstimateNormals, OrientsModels) {
  for (const char* name : {"m1", "m2"}) EXPECT_GT(orientation_found(model_cloud(name, 6000, 0.001)), 0.98) << name;
}

TEST(EstimateNormals, OrientsThinWalls) {
  PointCloud cloud;
  RandomStream random(1);
  const double spacing = 1.0 / std::sqrt(2500.0);
  add_box(cloud, {0, 0, 0}, {1, 1, 4 * spacing}, 2500, false, random);
  EXPECT_GT(orientation_found(cloud), 0.98);
}

TEST(EstimateNormals, OrientsBodiesApartAndCavities) {
  PointCloud cloud;
  RandomStream random(1);
  add_box(cloud, {0, 0, 0}, {1, 1, 1}, 900, false, random);
  add_box(cloud, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}, 900, true, random);
  add_box(cloud, {2, 0, 0}, {2.5, 0.5, 0.5}, 900, false, random);
  EXPECT_GT(orientation_found(cloud), 0.98);
}

TEST(EstimateNormals, OrientsNestedShells) {
  PointCloud cloud;
  RandomStream random(1);
  for (int shell = 0; shell < 4; ++shell) {
    const double margin = 0.12 * shell;
    add_box(cloud, Vector3d::Constant(margin), Vector3d::Constant(1.0 - margin), 1500, shell % 2 == 1, random);
  }
  EXPECT_GT(orientation_found(cloud), 0.98);
}

/// A wedge with an edge as sharp as this: its sides are nearly parallel where they meet.
PointCloud wedge_cloud(double angle_deg, RandomStream& random) {
  PointCloud cloud;
  const double height = std::tan(angle_deg * std::numbers::pi / 180.0);
  const Vector3d slope = Vector3d(-height, 0, 1).normalized();
  const auto add = [&cloud](const Vector3d& place, const Vector3d& normal) {
    cloud.positions.push_back(place);
    cloud.normals.push_back(normal);
  };
  for (int i = 0; i < 4000; ++i) {
    const double along = random.uniform();
    const double across = random.uniform();
    add({along, across, 0}, -Vector3d::UnitZ());
    add({along, across, height * along}, slope);
    if (random.chance(height)) add({1, along, height * across}, Vector3d::UnitX());
    if (random.chance(height / 2)) {
      const double from_edge = std::sqrt(along);
      add({from_edge, 0, height * from_edge * across}, -Vector3d::UnitY());
      add({from_edge, 1, height * from_edge * random.uniform()}, Vector3d::UnitY());
    }
  }
  return cloud;
}

TEST(EstimateNormals, OrientsBothSidesOfSharpEdges) {
  RandomStream random(4);
  for (const double angle_deg : {8.0, 15.0, 25.0}) {
    EXPECT_GT(orientation_found(wedge_cloud(angle_deg, random)), 0.97) << angle_deg;
  }
}

TEST(PrepareCloud, TellsWhereTheSideIsDoubtful) {
  PointCloud sheet;
  RandomStream random(6);
  for (int i = 0; i < 3000; ++i) sheet.positions.push_back({random.uniform(), random.uniform(), 0.0});
  const PreparedCloud doubtful = prepare_cloud(sheet);
  EXPECT_GT(doubtful.doubtful_normals, 0.01);
  EXPECT_TRUE(bounds_of(sheet.positions).contains(doubtful.doubtful_place));
  EXPECT_LT(prepare_cloud(without_normals(sphere_cloud(3000, 1.0, 0.002))).doubtful_normals, 0.01);
}

TEST(GrowPatches, DoNotCrossThinWalls) {
  PointCloud cloud;
  RandomStream random(2);
  add_box(cloud, {0, 0, 0}, {1, 1, 0.03}, 2500, false, random);
  const CentredPoints local = centred(cloud.positions);
  const NeighbourTree tree(local.points);
  const NeighbourTable neighbours = find_neighbours(local.points, tree, 20, {});
  // Unsure signs: every other normal is turned.
  Points normals = cloud.normals;
  for (std::size_t i = 0; i < normals.size(); i += 2) normals.set(i, -normals[i]);
  const Patches patches = grow_patches(local.points, normals, neighbours, 0.0, 5, 40);
  ASSERT_GT(patches.points.size(), 100U);
  std::size_t within = 0;
  for (const std::vector<std::uint32_t>& points : patches.points) {
    EXPECT_LE(points.size(), 40U);
    within += points.size();
    for (const std::uint32_t i : points) {
      EXPECT_GT(cloud.normals[i].dot(cloud.normals[points.front()]), 0.9);
      EXPECT_EQ(patches.flipped[i] != 0, normals[i].dot(normals[points.front()]) < 0.0);
    }
  }
  EXPECT_GT(within, cloud.size() * 9 / 10);
}

/// As seen from a ring of sensors around the middle, each point from one that sees its face, in many cases nearly along
/// it.
PointCloud seen(PointCloud cloud, const Vector3d& middle, double distance) {
  RandomStream random(11);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Vector3d sensor;
    do {
      const Vector3d direction(random.normal(), random.normal(), random.normal());
      sensor = middle + distance * direction.normalized();
    } while (cloud.normals[i].dot(sensor - cloud.positions[i]) < 0.03 * distance);
    cloud.sensor_positions.push_back(sensor);
  }
  return cloud;
}

TEST(EstimateNormals, LookTowardsTheirSensors) {
  PointCloud cloud;
  RandomStream random(1);
  // An open sheet, and a wall that is thinner than the points are apart: positions alone do not tell the sides.
  add_box(cloud, {0, 0, 0}, {1, 1, 0.005}, 1500, false, random);
  for (int i = 0; i < 1500; ++i) {
    cloud.positions.push_back({random.uniform(), random.uniform(), 2.0});
    cloud.normals.push_back(-Vector3d::UnitZ());
  }
  // One point in a hundred is on the wall's rim, which has no plane of its own.
  EXPECT_GT(orientation_found(seen(std::move(cloud), {0.5, 0.5, 1.0}, 6.0)), 0.98);
}

TEST(EstimateNormals, NeighboursDecideWhereSensorsSeeAlongTheSurface) {
  PointCloud cloud = sphere_cloud(3000, 1.0, 0.001);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    // One in three is seen along the surface, or a little from below as errors make it appear.
    const Vector3d along = cloud.normals[i].unitOrthogonal();
    const Vector3d towards = i % 3 == 0 ? (along - 0.1 * cloud.normals[i]).eval() : cloud.normals[i];
    cloud.sensor_positions.push_back(cloud.positions[i] + 5.0 * towards);
  }
  EXPECT_EQ(orientation_found(cloud), 1.0);
}

TEST(EstimateNormals, DoesNotDependOnUnitOriginAndThreads) {
  const PointCloud cloud = without_normals(sphere_cloud(2000, 1.0, 0.003));
  const PointCloud far = moved(cloud, 0.01, {1e4, -1e4, 1e4});
  const Points normals = estimate_normals(cloud, estimate_scale(cloud)).normals;
  EXPECT_GT(rightly_oriented(estimate_normals(far, estimate_scale(far)).normals, normals), 0.999);
  EXPECT_EQ(normals.x, estimate_normals(cloud, estimate_scale(cloud), {.threads = 2}).normals.x);
  RandomStream random(9);
  const PointCloud wedge = without_normals(wedge_cloud(15.0, random));
  EXPECT_EQ(estimate_normals(wedge, estimate_scale(wedge)).normals.x,
            estimate_normals(wedge, estimate_scale(wedge), {.threads = 2}).normals.x);
}

TEST(PrepareCloud, KeepsWhatBelongsToAPointTogether) {
  PointCloud cloud = sphere_cloud(4000, 1.0, 0.002);
  const std::size_t count = cloud.size();
  for (int outlier = 0; outlier < 4; ++outlier) cloud.positions.push_back({0.1 * outlier, 0.2, 0.3});
  cloud.normals = {};
  cloud.sensor_positions = cloud.positions;
  for (const bool has_duplicate : {false, true}) {
    if (has_duplicate) {
      cloud.positions.push_back(cloud.positions[7]);
      cloud.sensor_positions = cloud.positions;
    }
    const PreparedCloud prepared = prepare_cloud(cloud);
    EXPECT_TRUE(prepared.normals_estimated);
    EXPECT_EQ(prepared.cleaning.duplicates, has_duplicate ? 1U : 0U);
    EXPECT_EQ(prepared.cleaning.isolated + prepared.cleaning.off_surface, 4U);
    ASSERT_EQ(prepared.cloud.size(), count);
    EXPECT_EQ(prepared.cloud.sensor_positions.x, prepared.cloud.positions.x);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(prepared.cloud.positions[i], cloud.positions[i]) << i;
      ASSERT_GT(std::abs(prepared.cloud.normals[i].dot(cloud.positions[i])), 0.9) << i;
    }
  }
}

TEST(PrepareCloud, KeepsGoodNormals) {
  const PointCloud cloud = model_cloud("m1", 5000, 0.001);
  const PreparedCloud prepared = prepare_cloud(cloud);
  EXPECT_FALSE(prepared.normals_estimated);
  EXPECT_TRUE(prepared.warnings.empty()) << prepared.warnings.front();
}

TEST(PrepareCloud, TurnsInwardNormals) {
  PointCloud cloud = sphere_cloud(3000, 1.0, 0.002);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.normals.set(i, -cloud.normals[i]);
  const PreparedCloud prepared = prepare_cloud(cloud);
  EXPECT_FALSE(prepared.normals_estimated);
  EXPECT_TRUE(test::mentions(prepared.warnings, "turned"));
  EXPECT_EQ(rightly_oriented(prepared.cloud.normals, prepared.cloud.positions), 1.0);
}

/// Of a wall as thin as the points are apart, half of the neighbours are on its other side.
TEST(CheckNormals, AreKeptOnBothSidesOfAThinWall) {
  PointCloud wall;
  RandomStream random(4);
  for (int i = 0; i < 6000; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    wall.positions.push_back({random.uniform(-1, 1), random.uniform(-1, 1), side * 0.01});
    wall.normals.push_back({0, 0, side});
  }
  EXPECT_EQ(check_normals(wall, estimate_scale(wall)), NormalsVerdict::outward);
  for (std::size_t i = 0; i < wall.size(); ++i) {
    if (random.uniform() < 0.5) wall.normals.set(i, -wall.normals[i]);
  }
  EXPECT_EQ(check_normals(wall, estimate_scale(wall)), NormalsVerdict::unoriented);
}

/// At the edges and walls of a part of thin plates in noise, the points around a point have no plane.
TEST(CheckNormals, AreKeptOnThinPlatesInNoise) {
  PointCloud comb;
  RandomStream random(5);
  for (int i = 0; i < 40'000; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const double plate = static_cast<double>(random.below(8));
    const Vector3d noise(random.normal(), random.normal(), random.normal());
    comb.positions.push_back(Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0.32 * plate + side * 0.07) +
                             0.025 * noise);
    comb.normals.push_back({0, 0, side});
  }
  EXPECT_EQ(check_normals(comb, estimate_scale(comb)), NormalsVerdict::outward);
}

/// The flat half of a cloud is judged most strictly, but does not decide alone.
TEST(CheckNormals, AreFoundOutWhereOnlyTheRoundHalfIsRandom) {
  PointCloud cloud;
  RandomStream random(6);
  for (int i = 0; i < 8000; ++i) {
    cloud.positions.push_back({random.uniform(-1, 1), random.uniform(-1, 1), -2});
    cloud.normals.push_back({0, 0, 1});
    cloud.sensor_positions.push_back({0, 0, 20});
  }
  const PointCloud sphere = sphere_cloud(8000, 1.0, 0.0);
  for (std::size_t i = 0; i < sphere.size(); ++i) {
    cloud.positions.push_back(sphere.positions[i]);
    cloud.normals.push_back(Vector3d(random.normal(), random.normal(), random.normal()).normalized());
    cloud.sensor_positions.push_back(20 * sphere.positions[i]);
  }
  EXPECT_EQ(check_normals(cloud, estimate_scale(cloud)), NormalsVerdict::unoriented);
}

/// The points around an outlier have no plane.
TEST(CheckNormals, AreKeptBesideOutliersWithRandomOnes) {
  PointCloud cloud = sphere_cloud(8500, 1.0, 0.01);
  RandomStream random(7);
  for (int i = 0; i < 1500; ++i) {
    cloud.positions.push_back({random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)});
    cloud.normals.push_back(Vector3d(random.normal(), random.normal(), random.normal()).normalized());
  }
  EXPECT_EQ(check_normals(cloud, estimate_scale(cloud)), NormalsVerdict::outward);
}

/// Consistent with their neighbours, but not with an inside.
TEST(CheckNormals, AreFoundOutWhereTheyFaceTheWrongSide) {
  const PointCloud part = model_cloud("m0", 8000, 0.001);
  ASSERT_EQ(check_normals(part, estimate_scale(part)), NormalsVerdict::outward);
  const Eigen::Vector3d up = Eigen::Vector3d(0.3, 0.4, 0.8).normalized();
  PointCloud upward = part;
  PointCloud flipped = part;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part.normals[i].dot(up) < 0) upward.normals.set(i, -part.normals[i]);
    if (part.positions[i].x() > 0) flipped.normals.set(i, -part.normals[i]);
  }
  EXPECT_EQ(check_normals(upward, estimate_scale(part)), NormalsVerdict::unoriented);
  EXPECT_EQ(check_normals(flipped, estimate_scale(part)), NormalsVerdict::unoriented);
}

/// In noise, winding numbers at single points err by a third also with right normals.
TEST(CheckNormals, AreFoundOutOnTheUndersideInNoise) {
  const PrimitiveSet solids{test::placed("block", Box{{4, 3, 4}}, {0, 0, 0})};
  const PointCloud exact = sample_surface({.primitives = solids, .tree = CsgTree::leaf(0)}, {.count = 40000});
  PointCloud block = with_noise(exact, 0.025);
  EXPECT_EQ(check_normals(block, estimate_scale(block)), NormalsVerdict::outward);
  for (std::size_t i = 0; i < block.size(); ++i) {
    if (block.normals[i].z() < -0.5) block.normals.set(i, -block.normals[i]);
  }
  EXPECT_EQ(check_normals(block, estimate_scale(block)), NormalsVerdict::unoriented);
}

/// It has no inside that normals could lead into; those that it has are somebody's choice.
TEST(CheckNormals, AreKeptOnAnOpenSheet) {
  for (const double side : {1.0, -1.0}) {
    PointCloud sheet;
    RandomStream random(4);
    for (int i = 0; i < 4000; ++i) {
      const double x = random.uniform(-2, 2);
      const double y = random.uniform(-2, 2);
      sheet.positions.push_back({x, y, 0.2 * std::sin(2 * x) * std::cos(y)});
      sheet.normals.push_back(
          side *
          Eigen::Vector3d(-0.4 * std::cos(2 * x) * std::cos(y), 0.2 * std::sin(2 * x) * std::sin(y), 1).normalized());
    }
    EXPECT_EQ(check_normals(sheet, estimate_scale(sheet)), NormalsVerdict::outward);
  }
}

TEST(CheckNormals, SensorsTellWhetherNormalsLeadInward) {
  // A hemisphere: seen from within it is a bowl, whatever the winding number says.
  PointCloud cloud;
  const PointCloud sphere = sphere_cloud(4000, 1.0, 0.002);
  for (std::size_t i = 0; i < sphere.size(); ++i) {
    if (sphere.positions[i].z() > 0.0) continue;
    cloud.positions.push_back(sphere.positions[i]);
    cloud.normals.push_back(-sphere.normals[i]);
    cloud.sensor_positions.push_back({0, 0, 3});
  }
  EXPECT_EQ(check_normals(cloud, estimate_scale(cloud)), NormalsVerdict::outward);
  EXPECT_GT(orientation_found(cloud), 0.99);
}

TEST(PrepareCloud, EstimatesRandomNormalsAnew) {
  PointCloud cloud = sphere_cloud(3000, 1.0, 0.002);
  RandomStream random(2);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.normals.set(i, Vector3d(random.normal(), random.normal(), random.normal()).normalized());
  }
  const PreparedCloud prepared = prepare_cloud(cloud);
  EXPECT_TRUE(prepared.normals_estimated);
  EXPECT_TRUE(test::mentions(prepared.warnings, "estimated again"));
  EXPECT_EQ(rightly_oriented(prepared.cloud.normals, prepared.cloud.positions), 1.0);
  const PreparedCloud without = prepare_cloud(without_normals(cloud));
  EXPECT_EQ(prepared.cloud.positions.x, without.cloud.positions.x);
  EXPECT_EQ(prepared.cloud.normals.x, without.cloud.normals.x) << "as if no normals were given";
  EXPECT_EQ(prepared.doubted, without.doubted);
  EXPECT_EQ(prepared.scale.noise, without.scale.noise);
  // Signs alone by chance are of no use, either.
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.normals.set(i, (random.chance(0.5) ? 1.0 : -1.0) * cloud.positions[i].normalized());
  }
  EXPECT_TRUE(prepare_cloud(cloud).normals_estimated);
}

}  // namespace
}  // namespace cloud2csg
