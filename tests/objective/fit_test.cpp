#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "paper/objective/objective.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

constexpr double k_noise = 0.01;
constexpr double k_most_degrees = 30;
const ExtractOptions k_options{.segmentation = {.distance_tolerance = k_noise, .angle_tolerance_deg = k_most_degrees},
                               .objective = {.alpha = 5, .beta = 1 / k_noise, .gamma = 18 / std::numbers::pi}};
const Objective k_objective = resolve(k_options.objective, 0, k_noise);

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double quantile_95(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() * 95 / 100];
}

/// As it is defined: the whole tree at every point.
FitStatistics plain_fit(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud) {
  const std::vector<double> values = implicit_value(tree, primitives, cloud.positions);
  const Points slopes = implicit_gradient(tree, primitives, cloud.positions);
  std::vector<double> distances, angles;
  FitStatistics fit{.objective = -k_objective.alpha * static_cast<double>(tree.size())};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double slope = slopes[i].norm();
    distances.push_back(std::abs(values[i]) / (slope > 0 ? slope : 1));
    angles.push_back(std::acos(std::clamp(slopes[i].normalized().dot(cloud.normals[i]), -1.0, 1.0)));
    fit.objective += point_score(values[i], angles.back(), k_objective);
    const bool is_explained = distances.back() <= k_noise && angles.back() <= k_most_degrees * std::numbers::pi / 180;
    fit.unexplained_points += is_explained ? 0 : 1;
  }
  fit.rms_distance = root_mean_square(distances);
  fit.p95_distance = quantile_95(distances);
  fit.rms_angle_deg = root_mean_square(angles) * 180 / std::numbers::pi;
  fit.p95_angle_deg = quantile_95(angles) * 180 / std::numbers::pi;
  return fit;
}

void expect_plain_fit(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud) {
  const FitStatistics expected = plain_fit(tree, primitives, cloud);
  const SegmentationTolerances tolerances = segmentation_tolerances(k_options.segmentation, k_noise);
  for (const int threads : {1, 3}) {
    const FitStatistics fit =
        measure_fit({.primitives = primitives, .tree = tree}, cloud, k_noise, k_options, {.threads = threads});
    EXPECT_EQ(
        fit.unexplained_points,
        unexplained_points({.primitives = primitives, .tree = tree}, cloud, tolerances, {.threads = threads}).size());
    EXPECT_EQ(fit.unexplained_points, expected.unexplained_points);
    EXPECT_NEAR(fit.objective, expected.objective, 1e-9 * static_cast<double>(cloud.size()));
    EXPECT_NEAR(fit.rms_distance, expected.rms_distance, 1e-12 * expected.rms_distance);
    EXPECT_EQ(fit.p95_distance, expected.p95_distance);
    EXPECT_NEAR(fit.rms_angle_deg, expected.rms_angle_deg, 1e-6);
    EXPECT_NEAR(fit.p95_angle_deg, expected.p95_angle_deg, 1e-6);
  }
}

/// Solids of all kinds in a cube of side 12, a few of them displaced, expressions or half-spaces.
PrimitiveSet wide_primitives(std::size_t count, RandomStream& random) {
  PrimitiveSet primitives = test::random_primitives(count, random);
  for (Primitive& primitive : primitives) {
    if (std::holds_alternative<HalfSpace>(primitive.shape) && random.chance(0.7)) primitive.shape = Sphere{0.7};
    primitive.pose.position = test::random_within(6, random);
  }
  return primitives;
}

/// On and near the surfaces, anywhere among the solids, and far away.
PointCloud wide_cloud(const PrimitiveSet& primitives, std::size_t count, RandomStream& random) {
  PointCloud cloud;
  while (cloud.size() < count) {
    const Primitive& primitive = primitives[random.below(primitives.size())];
    Eigen::Vector3d point = primitive.pose.position + test::random_within(1.5, random);
    const Points start = test::single(point);
    point -= signed_distance(primitive, start)[0] * gradient(primitive, start)[0];
    if (random.chance(0.5)) point += test::random_within(0.02, random);
    if (random.chance(0.1)) point = test::random_within(8, random);
    if (random.chance(0.02)) point = test::random_within(500, random);
    if (!point.allFinite() || point.norm() > 1000) continue;
    cloud.positions.push_back(point);
    cloud.normals.push_back(test::random_normal(primitives, point, random));
  }
  return cloud;
}

TEST(MeasureFit, OfLargeTreesIsThatOfThePlainEvaluation) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    RandomStream random(seed);
    const PrimitiveSet primitives = wide_primitives(60 + random.below(60), random);
    const PointCloud cloud = wide_cloud(primitives, 5000, random);
    std::vector<CsgTree> leaves;
    for (PrimitiveIndex p = 0; p < primitives.size(); ++p) leaves.push_back(CsgTree::leaf(p));
    const CsgTree all = unite_all(leaves);
    for (const CsgTree& tree : {all, complement(all), test::random_formula(primitives.size(), 150, random),
                                subtract(CsgTree::leaf(0), all), subtract(all, test::random_formula(40, 40, random))}) {
      expect_plain_fit(tree, primitives, cloud);
    }
  }
}

TEST(MeasureFit, OfSmallTreesIsThatOfThePlainEvaluation) {
  RandomStream random(11);
  const PrimitiveSet primitives = wide_primitives(60, random);
  const PointCloud cloud = wide_cloud(primitives, 3000, random);
  for (const std::size_t used : {1U, 5U, 32U}) {
    expect_plain_fit(test::random_formula(used, 2 * used, random), primitives, cloud);
  }
}

/// All points are so far that no part of the tree will do for them.
TEST(MeasureFit, TakesCloudsThatAreElsewhere) {
  RandomStream random(13);
  PrimitiveSet primitives = wide_primitives(50, random);
  std::vector<CsgTree> leaves;
  for (PrimitiveIndex p = 0; p < primitives.size(); ++p) {
    if (std::holds_alternative<HalfSpace>(primitives[p].shape)) primitives[p].shape = Sphere{1};
    leaves.push_back(CsgTree::leaf(p));
  }
  PointCloud cloud;
  for (int i = 0; i < 100; ++i) {
    cloud.positions.push_back(Eigen::Vector3d(1e4, 0, 0) + test::random_within(1, random));
    cloud.normals.push_back(Eigen::Vector3d::UnitX());
  }
  expect_plain_fit(unite_all(leaves), primitives, cloud);
  PointCloud one;
  one.positions.push_back({20, 0, 0});
  one.normals.push_back(Eigen::Vector3d::UnitX());
  expect_plain_fit(unite_all(leaves), primitives, one);
}

/// Two surfaces in one place: whose normal counts is as in the plain evaluation.
TEST(MeasureFit, SettlesTiesAsThePlainEvaluation) {
  PrimitiveSet primitives;
  std::vector<CsgTree> leaves;
  RandomStream random(17);
  for (int i = 0; i < 40; ++i) {
    for (const char* name : {"box", "ball"}) {
      const Shape shape = *name == 'b' && name[1] == 'o' ? Shape(Box{{1, 1, 1}}) : Shape(Sphere{0.5});
      primitives.push_back(test::placed(name + std::to_string(i), shape, {1.0 * i, 0, 0}));
    }
  }
  for (PrimitiveIndex p = 0; p < primitives.size(); ++p) leaves.push_back(CsgTree::leaf(p));
  PointCloud cloud;
  for (int i = 0; i < 2000; ++i) {
    const double x = test::quarters(0, 160, random);
    const double y = test::quarters(-3, 3, random);
    cloud.positions.push_back({x, y, test::quarters(-3, 3, random)});
    cloud.normals.push_back(test::random_direction(random));
  }
  expect_plain_fit(unite_all(leaves), primitives, cloud);
  for (const std::size_t size : {100U, 300U}) {
    expect_plain_fit(test::random_formula(primitives.size(), size, random), primitives, cloud);
  }
}

}  // namespace
}  // namespace cloud2csg
