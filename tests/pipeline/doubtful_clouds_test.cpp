#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "core/base/random.hpp"
#include "core/geometry/subset.hpp"
#include "pipeline/reconstructed.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_scatter = 0.003;

/// What became of a cloud: a tree with warnings, or a refusal.
struct Ending {
  std::string refusal = {};
  std::vector<std::string> warnings = {};
  Extraction result = {};

  [[nodiscard]] bool is_doubted() const { return !refusal.empty() || !warnings.empty(); }
};

Ending ending_of(const PointCloud& cloud, std::optional<double> seconds = {}) {
  try {
    Extraction result = reconstruct(cloud, {.extraction = {.time_limit_seconds = seconds}});
    return {.warnings = result.statistics.warnings, .result = std::move(result)};
  } catch (const Error& error) {
    return {.refusal = error.what()};
  }
}

PointCloud points_of(const Model& model, std::size_t count) {
  PointCloud cloud = sample_surface(model, {.count = count, .noise = k_scatter, .seed = 3});
  cloud.normals = {};
  return cloud;
}

/// z over a square with noise; no normals.
PointCloud sheet(const std::function<double(double, double)>& height) {
  RandomStream random(1);
  PointCloud cloud;
  for (int i = 0; i < 2500; ++i) {
    const double x = random.uniform(-2, 2);
    const double y = random.uniform(-2, 2);
    cloud.positions.push_back({x, y, height(x, y) + k_scatter * random.normal()});
  }
  return cloud;
}

Model box_and(const Primitive& other) {
  return {.primitives = {test::placed("box", Box{{2, 1.5, 1}}, {0, 0, 0}), other},
          .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
}

TEST(DoubtfulClouds, APlaneIsRefusedOrDoubted) {
  EXPECT_TRUE(ending_of(sheet([](double, double) { return 0.0; })).is_doubted());
}

TEST(DoubtfulClouds, AnOpenSheetIsRefusedOrDoubted) {
  EXPECT_TRUE(ending_of(sheet([](double x, double) { return 0.2 * x * x; })).is_doubted());
}

/// Its solids would be looked for for long.
TEST(DoubtfulClouds, ATerrainIsRefusedOrDoubted) {
  const PointCloud terrain = sheet(
      [](double x, double y) { return 0.3 * std::sin(2 * x) * std::cos(1.7 * y) + 0.1 * std::sin(5 * x + 3 * y); });
  EXPECT_TRUE(ending_of(terrain, 2.0).is_doubted());
}

TEST(DoubtfulClouds, TwoObjectsAreBothFound) {
  const Model truth = box_and(test::placed("ball", Sphere{0.7}, {3.5, 0, 0}));
  const Ending ending = ending_of(points_of(truth, 12'000));
  ASSERT_EQ(ending.refusal, "");
  EXPECT_GT(test::iou(ending.result, truth), 0.98);
  EXPECT_EQ(leaf_count(ending.result.tree()), 2U);
}

TEST(DoubtfulClouds, HalfOfThePointsMayBeOutliers) {
  const Model truth = box_and(test::placed("boss", Cylinder{.radius = 0.4, .height = 1}, {0.2, 0, 0.6}));
  PointCloud cloud = points_of(truth, 12'000);
  RandomStream random(5);
  for (int i = 0; i < 12'000; ++i) cloud.positions.push_back(test::random_within(2, random));
  const Ending ending = ending_of(cloud);
  ASSERT_EQ(ending.refusal, "");
  EXPECT_GT(test::iou(ending.result, truth), 0.95);
  EXPECT_FALSE(ending.warnings.empty());
}

TEST(DoubtfulClouds, CoordinatesMayBeGeoreferenced) {
  Model truth = box_and(test::placed("boss", Cylinder{.radius = 0.4, .height = 1}, {0.2, 0, 0.6}));
  const Vector3d place(4'512'345.678, 5'412'345.678, 312.5);
  for (Primitive& primitive : truth.primitives) primitive.pose.position += place;
  const Ending ending = ending_of(points_of(truth, 12'000));
  ASSERT_EQ(ending.refusal, "");
  EXPECT_GT(test::iou(ending.result, truth), 0.98);
  EXPECT_EQ(leaf_count(ending.result.tree()), 2U);
}

TEST(DoubtfulClouds, AHundredPointsGiveABoxOrARefusal) {
  const Model truth{.primitives = {test::placed("box", Box{{2, 1.5, 1}}, {0, 0, 0})}, .tree = CsgTree::leaf(0)};
  const Ending ending = ending_of(points_of(truth, 100));
  EXPECT_TRUE(ending.is_doubted() || test::iou(ending.result, truth) > 0.9);
}

TEST(DoubtfulClouds, AHoleLargerThanAFaceIsToldOf) {
  const Model truth = box_and(test::placed("boss", Cylinder{.radius = 0.4, .height = 1}, {0.2, 0, 0.6}));
  PointCloud seen;
  const PointCloud all = points_of(truth, 12'000);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all.positions[i].x() < 0.75) seen.positions.push_back(all.positions[i]);
  }
  const Ending ending = ending_of(seen);
  EXPECT_TRUE(ending.is_doubted());
}

}  // namespace
}  // namespace cloud2csg
