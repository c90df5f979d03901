#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>

#include "cells/crossings.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/geometry/spatial_order.hpp"
#include "support/known_solids.hpp"
#include "support/scene.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

CellOptions options_with(std::size_t lines) {
  return {.tolerances = test::scene_tolerances(),
          .noise = test::k_scene_noise,
          .precision = Precision::full,
          .sight_lines = lines};
}

Points only(const Vector3d& place) {
  Points points;
  points.push_back(place);
  return points;
}

double distance_at(const Primitive& primitive, const Vector3d& place) {
  return signed_distance(primitive, only(place))[0];
}

/// By cell: lines that have a place in it that is clearly on one side of each primitive.
std::map<Cell, std::uint64_t> plain_count(const SightLines& lines, const PrimitiveSet& primitives, double tolerance) {
  std::map<Cell, std::uint64_t> counts;
  for (std::size_t line = 0; line < lines.count; ++line) {
    std::map<Cell, bool> seen;
    for (std::size_t k = 0; k < k_places_a_line; ++k) {
      const Vector3d place = lines.places.positions[line * k_places_a_line + k];
      Cell cell;
      bool is_clear = true;
      for (PrimitiveIndex p = 0; p < primitives.size(); ++p) {
        const double distance = distance_at(primitives[p], place);
        is_clear = is_clear && std::abs(distance) > tolerance;
        if (distance < 0) cell.push_back(p);
      }
      if (is_clear) seen[cell] = true;
    }
    for (const auto& [cell, is_seen] : seen) ++counts[cell];
  }
  return counts;
}

PointCloud seen_by(PointCloud cloud, std::span<const Vector3d> sensors, RandomStream& random) {
  cloud.sensor_positions = {};
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.sensor_positions.push_back(sensors[random.below(sensors.size())]);
  return cloud;
}

RC_GTEST_PROP(CountLines, IsThePlainRuleAtEachPlaceOfAnyScene, (std::uint64_t seed)) {
  RandomStream random(seed);
  test::Scene scene = test::random_scene(1 + random.below(6), 1, random);
  const std::vector<Vector3d> sensors{{5, 1, 0}, {0, -6, 2}, {-1, 0, 7}};
  const PointCloud cloud =
      seen_by(test::random_cloud(scene.primitives, 1 + random.below(300), random), sensors, random);
  const CellOptions options = options_with(1 + random.below(200));
  const AlignedBox box = bounds_of(cloud.positions);
  const ReachingPrimitives reaching = reaching_primitives(scene.primitives, box, options);
  const SightLines lines = find_sight_lines(cloud, spatial_order(cloud.positions, box), reaching, options, {});
  RC_ASSERT(lines.count <= options.sight_lines);
  RC_PRE(lines.count > 0U);
  for (const int threads : {1, 2, 3}) {
    std::map<Cell, std::uint64_t> counts;
    for (const Crossings& share : count_lines(lines, reaching, options.tolerances, {.threads = threads})) {
      for (const auto& [pair, units] : share.units) {
        RC_ASSERT(Crossings::inner(pair) == Crossings::outer(pair));
        counts[share.cells[Crossings::inner(pair)]] += units;
      }
    }
    RC_ASSERT(counts == plain_count(lines, scene.primitives, options.tolerances.distance));
  }
}

TEST(FindSightLines, KnowsNoneWithoutSensors) {
  RandomStream random(1);
  const test::Scene scene = test::random_scene(3, 100, random);
  const AlignedBox box = bounds_of(scene.cloud.positions);
  const CellOptions options = options_with(100);
  EXPECT_EQ(find_sight_lines(scene.cloud, spatial_order(scene.cloud.positions, box),
                             reaching_primitives(scene.primitives, box, options), options, {})
                .count,
            0);
}

/// A plate with a hole, whose wall no point is on, above a table that was seen through the hole.
class HoleWithoutPoints : public ::testing::Test {
 protected:
  HoleWithoutPoints() {
    RandomStream random(3);
    for (int i = 0; i < 6000; ++i) {
      const Vector3d place{random.uniform(-1, 1), random.uniform(-1, 1), 0};
      const bool is_in_hole = place.head<2>().norm() < 0.3;
      if (!is_in_hole) add(place + Vector3d(0, 0, 0.4), Vector3d::UnitZ());
      // The table is seen from above where the plate does not hide it.
      if (is_in_hole) add(place - Vector3d(0, 0, 0.7), Vector3d::UnitZ());
      const Vector3d beside{random.uniform(1.2, 2), random.uniform(-1, 1), -0.7};
      add(beside, Vector3d::UnitZ());
    }
    for (const Vector3d& side : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0)}) {
      for (int i = 0; i < 1000; ++i) {
        const Vector3d along(side.y(), side.x(), 0);
        add(side + random.uniform(-1, 1) * along + random.uniform(-0.4, 0.4) * Vector3d::UnitZ(), side);
      }
    }
  }

  void add(const Vector3d& position, const Vector3d& normal) {
    cloud_.positions.push_back(position);
    cloud_.normals.push_back(normal);
    cloud_.sensor_positions.push_back(position + Vector3d(0, 0, 20));
  }

  [[nodiscard]] bool is_solid_at(const Vector3d& place) const {
    constexpr double k_range_noise = 0.01;
    const CellComplex complex = find_cells(
        cloud_, primitives_, {.tolerances = segmentation_tolerances({}, k_range_noise), .noise = k_range_noise});
    const CsgTree tree = solve_cells(complex, label_cells(complex)).value().tree;
    return implicit_value(tree, primitives_, only(place))[0] < 0;
  }

  PrimitiveSet primitives_{
      {.id = "plate", .shape = Box{.size = {2, 2, 0.8}}, .pose = {}},
      {.id = "hole", .shape = Cylinder{.radius = 0.3, .height = 0.9}, .pose = {}},
      {.id = "table", .shape = Box{.size = {3.2, 2.2, 0.2}}, .pose = {.position = {0.5, 0, -0.8}}},
  };
  PointCloud cloud_;
};

TEST_F(HoleWithoutPoints, IsSeenThroughByAsManyForAnyNumberOfThreads) {
  const CellOptions options = options_with(7001);  // of which each stands for no whole number of points
  const std::vector<double> expected = find_cells(cloud_, primitives_, options).seen_through;
  ASSERT_FALSE(expected.empty());
  for (const int threads : {2, 3}) {
    EXPECT_EQ(find_cells(cloud_, primitives_, options, {.threads = threads}).seen_through, expected) << threads;
  }
}

TEST_F(HoleWithoutPoints, IsThereSinceItWasSeenThrough) {
  EXPECT_FALSE(is_solid_at({0, 0, 0}));
  EXPECT_TRUE(is_solid_at({0.6, 0, 0}));
  EXPECT_TRUE(is_solid_at({0.6, 0, -0.75}));
}

TEST_F(HoleWithoutPoints, IsNotFoundWhereNothingIsKnownOfTheSensors) {
  cloud_.sensor_positions = {};
  EXPECT_TRUE(is_solid_at({0, 0, 0}));
}

TEST_F(HoleWithoutPoints, IsNotMadeByOutliersBehindTheSolid) {
  for (int i = 0; i < 600; ++i) add({-0.7, 0.1, -0.55}, Vector3d::UnitZ());
  EXPECT_TRUE(is_solid_at({-0.7, 0.1, 0}));
}

}  // namespace
}  // namespace cloud2csg
