#include "cloud2csg/advanced/segmentation.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <stop_token>

#include "cloud2csg/error.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

/// Boxes and spheres that do not touch, of about unit size.
PrimitiveSet boxes_and_spheres() {
  return {test::placed("box", Box{{1, 0.8, 0.6}}, {0, 0, 0}), test::placed("ball", Sphere{0.5}, {2, 0, 0}),
          test::placed("cube", Box{{0.9, 0.9, 0.9}}, {0, 2, 0}), test::placed("globe", Sphere{0.7}, {2, 2, 0})};
}

CsgTree all_united(const PrimitiveSet& primitives) {
  std::vector<CsgTree> leaves;
  for (PrimitiveIndex p = 0; p < primitives.size(); ++p) leaves.push_back(CsgTree::leaf(p));
  return unite_all(leaves);
}

/// One in ten points is replaced by one anywhere.
void add_outliers(PointCloud& cloud, RandomStream& random) {
  for (std::size_t i = 0; i < cloud.size(); i += 10) {
    cloud.positions.set(i, Eigen::Vector3d(1, 1, 0) + test::random_within(2, random));
    cloud.normals.set(i, test::random_direction(random));
  }
}

TEST(EstimateNoise, RecoversTheSigmaOfAScan) {
  const PrimitiveSet primitives = boxes_and_spheres();
  for (const double sigma : {0.002, 0.005, 0.01, 0.02, 0.05}) {
    const PointCloud cloud = sample_surface({.primitives = primitives, .tree = all_united(primitives)},
                                            {.count = 20'000, .noise = sigma, .seed = 5});
    EXPECT_NEAR(estimate_noise(cloud, primitives), sigma, 0.1 * sigma);
  }
}

TEST(EstimateNoise, SurvivesATenthOfOutliers) {
  const PrimitiveSet primitives = boxes_and_spheres();
  RandomStream random(1);
  for (const double sigma : {0.002, 0.005, 0.01, 0.02, 0.05}) {
    PointCloud cloud = sample_surface({.primitives = primitives, .tree = all_united(primitives)},
                                      {.count = 20'000, .noise = sigma, .seed = 6});
    add_outliers(cloud, random);
    EXPECT_NEAR(estimate_noise(cloud, primitives), sigma, 0.1 * sigma);
  }
}

TEST(EstimateNoise, ScalesWithTheCloud) {
  const PrimitiveSet unit{test::placed("ball", Sphere{1}, {0, 0, 0})};
  const PrimitiveSet large{test::placed("ball", Sphere{1000}, {0, 0, 0})};
  const double of_unit =
      estimate_noise(sample_surface({.primitives = unit, .tree = CsgTree::leaf(0)}, {.noise = 0.01, .seed = 3}), unit);
  const double of_large =
      estimate_noise(sample_surface({.primitives = large, .tree = CsgTree::leaf(0)}, {.noise = 10, .seed = 3}), large);
  EXPECT_NEAR(of_large / of_unit, 1000, 100);
}

TEST(EstimateNoise, APerfectCloudHasTheFloor) {
  const PrimitiveSet primitives = boxes_and_spheres();
  const PointCloud cloud =
      sample_surface({.primitives = primitives, .tree = all_united(primitives)}, {.count = 4000, .seed = 4});
  const double diagonal = bounds_of(cloud.positions).diagonal().norm();
  const double noise = estimate_noise(cloud, primitives);
  EXPECT_GT(noise, 0.99e-5 * diagonal);
  EXPECT_LT(noise, 1.01e-5 * diagonal);
}

TEST(EstimateNoise, IsAUsableScaleForASinglePoint) {
  PointCloud cloud;
  cloud.positions.push_back({1, 0, 0});
  cloud.normals.push_back({1, 0, 0});
  const double noise = estimate_noise(cloud, {test::placed("ball", Sphere{1}, {0, 0, 0})});
  EXPECT_GT(noise, 0.0);
  EXPECT_LT(noise, 1e-3);
  EXPECT_TRUE(std::isfinite(1 / noise));
}

TEST(EstimateNoise, SurfacesThatFaceElsewhereDoNotCount) {
  PointCloud cloud;
  for (int i = 0; i < 100; ++i) {
    cloud.positions.push_back({1 + 0.001 * i, 0, 0});
    cloud.normals.push_back({0, 0, 1});
  }
  // Every point is near the sphere, none agrees with it: nothing to measure but the floor.
  EXPECT_NEAR(estimate_noise(cloud, {test::placed("ball", Sphere{1}, {0, 0, 0})}), 1e-5 * 0.099, 1e-9);
}

TEST(SegmentationTolerances, AreThreeSigmasUnlessGiven) {
  const SegmentationTolerances derived = segmentation_tolerances({}, 0.02);
  EXPECT_DOUBLE_EQ(derived.distance, 0.06);
  EXPECT_DOUBLE_EQ(derived.cosine, std::cos(std::numbers::pi / 6));
  const SegmentationTolerances given =
      segmentation_tolerances({.distance_tolerance = 0.5, .angle_tolerance_deg = 60}, 0.02);
  EXPECT_DOUBLE_EQ(given.distance, 0.5);
  EXPECT_DOUBLE_EQ(given.cosine, std::cos(std::numbers::pi / 3));
}

/// As the header puts it, one point at a time.
bool belongs(const Primitive& primitive, const Eigen::Vector3d& at, const Eigen::Vector3d& normal,
             const SegmentationTolerances& tolerances) {
  const Points point = test::single(at);
  const double cosine = gradient(primitive, point)[0].normalized().dot(normal);
  return std::abs(signed_distance(primitive, point)[0]) <= tolerances.distance && std::abs(cosine) >= tolerances.cosine;
}

RC_GTEST_PROP(SegmentPoints, ListsThePointsThatAreNearAndFaceOneOfTheTwoWays, (std::uint64_t seed)) {
  RandomStream random(seed);
  const PrimitiveSet primitives = test::random_primitives(1 + random.below(6), random);
  const PointCloud cloud = test::random_cloud(primitives, 100, random);
  // No round angle, at which the last bit of a cosine decides.
  const SegmentationTolerances tolerances{.distance = 0.0371, .cosine = random.uniform(0.05, 0.99)};
  const Segmentation result = segment_points(cloud, primitives, tolerances);
  std::vector<bool> assigned(cloud.size(), false);
  RC_ASSERT(result.points_of.size() == primitives.size());
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < cloud.size(); ++i) {
      if (!belongs(primitives[p], cloud.positions[i], cloud.normals[i], tolerances)) continue;
      expected.push_back(i);
      assigned[i] = true;
    }
    RC_ASSERT(result.points_of[p] == expected);
  }
  RC_ASSERT(result.unassigned == static_cast<std::size_t>(std::ranges::count(assigned, false)));
}

TEST(SegmentPoints, APointOnAnEdgeBelongsToBothSolids) {
  const PrimitiveSet primitives{test::placed("a", Box{{2, 2, 2}}, {0, 0, 0}),
                                test::placed("b", Box{{2, 2, 2}}, {1, 1, 0}),
                                test::placed("far", Sphere{0.5}, {9, 9, 9})};
  PointCloud cloud;
  cloud.positions.push_back({0.5, 0.5, 1});
  cloud.normals.push_back({0, 0, 1});
  cloud.positions.push_back({5, 5, 5});
  cloud.normals.push_back({0, 0, 1});
  const Segmentation result = segment_points(cloud, primitives, {.distance = 0.01, .cosine = 0.9});
  EXPECT_EQ(result.points_of[0], std::vector<std::uint32_t>{0});
  EXPECT_EQ(result.points_of[1], std::vector<std::uint32_t>{0});
  EXPECT_TRUE(result.points_of[2].empty());
  EXPECT_EQ(result.unassigned, 1U);
}

TEST(SegmentPoints, ASubtractedSolidShowsItsSurfaceFromInside) {
  const PrimitiveSet primitives{test::placed("block", Box{{2, 2, 2}}, {0, 0, 0}),
                                test::placed("bore", Cylinder{0.5, 3}, {0, 0, 0})};
  const PointCloud cloud = sample_surface(
      {.primitives = primitives, .tree = subtract(CsgTree::leaf(0), CsgTree::leaf(1))}, {.count = 5000, .seed = 2});
  const Segmentation result = segment_points(cloud, primitives, {.distance = 1e-6, .cosine = 0.99});
  EXPECT_EQ(result.unassigned, 0U);
  // The wall of the bore is 2 pi of 24 - pi / 2 + 2 pi in all.
  const double share = 2 * std::numbers::pi / (24 + 1.5 * std::numbers::pi);
  EXPECT_NEAR(static_cast<double>(result.points_of[1].size()), 5000 * share, 150);
}

TEST(SegmentPoints, StopsWhenAsked) {
  const PrimitiveSet primitives = boxes_and_spheres();
  const PointCloud cloud = sample_surface({.primitives = primitives, .tree = all_united(primitives)}, {.count = 100});
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)segment_points(cloud, primitives, {.distance = 1, .cosine = 0}, {.stop = stop.get_token()}),
               Cancelled);
}

TEST(SegmentPoints, ReportsEachPrimitive) {
  const PrimitiveSet primitives = boxes_and_spheres();
  const PointCloud cloud = sample_surface({.primitives = primitives, .tree = all_united(primitives)}, {.count = 100});
  std::vector<std::size_t> done;
  (void)segment_points(cloud, primitives, {.distance = 1, .cosine = 0}, {.on_progress = [&done](const Progress& p) {
                         EXPECT_EQ(p.stage, "segment");
                         EXPECT_EQ(p.total, 4U);
                         done.push_back(p.done);
                       }});
  EXPECT_EQ(done, (std::vector<std::size_t>{1, 2, 3, 4}));
}

TEST(DealPoints, GivesEachPointToTheNearestOnly) {
  // Walls that are nearer to each other than the tolerance.
  const PrimitiveSet primitives{test::placed("inner", Sphere{1.0}, {0, 0, 0}),
                                test::placed("outer", Sphere{1.02}, {0, 0, 0})};
  PointCloud cloud;
  RandomStream random(7);
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d direction = test::random_direction(random);
    cloud.positions.push_back((i % 3 == 0 ? 1.018 : 1.003) * direction);
    cloud.normals.push_back(i % 2 == 0 ? direction : Eigen::Vector3d(-direction));
  }
  const std::vector<SurfacePoints> dealt = deal_points(cloud, primitives, {.distance = 0.05, .cosine = 0.9});
  ASSERT_EQ(dealt.size(), 2U);
  EXPECT_EQ(dealt[0].points.size(), 2000U);
  EXPECT_EQ(dealt[1].points.size(), 1000U);
  EXPECT_NEAR(dealt[0].rms, 0.003, 1e-9);
  EXPECT_NEAR(dealt[1].rms, 0.002, 1e-9);
  for (const std::uint32_t i : dealt[1].points) EXPECT_EQ(i % 3, 0U);
}

TEST(DealPoints, MeasuresTheDistanceFromFreeForms) {
  // Its field is 5 times the distance from a sphere, and so is that of its waves.
  Primitive form = test::placed("form", Expression{"5 * (sqrt(x^2 + y^2 + z^2) - 1)", {}}, {0, 0, 0});
  std::get<Expression>(form.shape).bounds = AlignedBox(Eigen::Vector3d(-2, -2, -2), Eigen::Vector3d(2, 2, 2));
  const PrimitiveSet plain{test::placed("ball", Sphere{1.0}, {0, 0, 0})};
  const PointCloud cloud =
      sample_surface({.primitives = plain, .tree = CsgTree::leaf(0)}, {.count = 5000, .noise = 0.01, .seed = 2});
  const SurfacePoints own = deal_points(cloud, {form}, {.distance = 0.05, .cosine = 0.9})[0];
  EXPECT_EQ(own.points.size(), cloud.size());
  EXPECT_NEAR(own.rms, 0.01, 0.0005);
}

TEST(DealPoints, LeavesOutWhatIsFarOrTurned) {
  const PrimitiveSet primitives{test::placed("ball", Sphere{1.0}, {0, 0, 0})};
  PointCloud cloud;
  for (const double radius : {1.0, 1.2}) {
    cloud.positions.push_back({radius, 0, 0});
    cloud.normals.push_back({1, 0, 0});
  }
  cloud.positions.push_back({0, 1, 0});
  cloud.normals.push_back({1, 0, 0});
  EXPECT_EQ(deal_points(cloud, primitives, {.distance = 0.1, .cosine = 0.9})[0].points, std::vector<std::uint32_t>{0});
}

TEST(DealPoints, IsTheSameOnAnyNumberOfThreads) {
  const PrimitiveSet primitives = boxes_and_spheres();
  const PointCloud cloud =
      sample_surface({.primitives = primitives, .tree = all_united(primitives)}, {.count = 5000, .noise = 0.01});
  const SegmentationTolerances tolerances{.distance = 0.03, .cosine = 0.9};
  const auto one = deal_points(cloud, primitives, tolerances, {.threads = 1});
  const auto two = deal_points(cloud, primitives, tolerances, {.threads = 2});
  ASSERT_EQ(one.size(), primitives.size());
  ASSERT_EQ(two.size(), primitives.size());
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    EXPECT_GT(one[p].points.size(), 0U);
    EXPECT_EQ(one[p].points, two[p].points);
    EXPECT_EQ(one[p].rms, two[p].rms);
  }
}

}  // namespace
}  // namespace cloud2csg
