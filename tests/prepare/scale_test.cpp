#include <gtest/gtest.h>

#include <numbers>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/random.hpp"
#include "prepare/clouds.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

TEST(EstimateScale, FindsTheNoiseOfASphere) {
  const double diagonal = 2.0 * std::sqrt(3.0);
  for (const double noise : {0.0005, 0.002, 0.01}) {
    const Scale scale = estimate_scale(sphere_cloud(8000, 1.0, noise * diagonal));
    EXPECT_NEAR(scale.noise / (noise * diagonal), 1.0, 0.25) << noise;
  }
  EXPECT_LT(estimate_scale(sphere_cloud(8000, 1.0, 0.0)).noise, 1e-4 * diagonal);
}

TEST(EstimateScale, FindsTheNoiseOfModelsWithEdges) {
  for (const char* name : {"m0", "m2"}) {
    for (const double noise : {0.001, 0.005}) {
      const PointCloud cloud = model_cloud(name, 20'000, noise);
      const Scale scale = estimate_scale(cloud);
      EXPECT_NEAR(scale.noise / (noise * scale.diagonal), 1.0, 0.3) << name << ' ' << noise;
    }
  }
}

/// Neighbourhoods are balls: where the noise exceeds the spacing, they cut off what lies far from their centres.
TEST(EstimateScale, FindsNoiseThatExceedsTheSpacing) {
  const auto estimated_share = [](double noise) {
    PointCloud sheet;
    RandomStream random(7);
    for (int i = 0; i < 40'000; ++i) {
      sheet.positions.push_back({random.uniform(0, 200), random.uniform(0, 200), noise * random.normal()});
    }
    return estimate_scale(sheet).noise / noise;
  };
  for (const double noise : {0.25, 0.5, 1.0, 2.0, 3.0}) EXPECT_NEAR(estimated_share(noise), 1.0, 0.2) << noise;
  EXPECT_NEAR(estimated_share(8), 1.0, 0.4) << "the widest neighbourhoods are balls of noise, too";
}

/// Neighbourhoods that are wider than the wall is thick see both of its sides and take the wall for noise.
TEST(EstimateScale, DoesNotTakeAWallForNoise) {
  PointCloud tube;
  RandomStream random(3);
  for (int i = 0; i < 20'000; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double radius = (i % 2 == 0 ? 0.9 : 1.1) + 0.04 * random.normal();
    tube.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), random.uniform(-1, 1)});
  }
  EXPECT_NEAR(estimate_scale(tube).noise, 0.04, 0.008);
}

/// A tube whose wall is thinner than the distance of its points: of each neighbourhood, half is on the other side.
TEST(EstimateScale, SeesNoNoiseInAThinWall) {
  PointCloud tube;
  RandomStream random(3);
  for (int i = 0; i < 20'000; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double radius = i % 2 == 0 ? 1.0 : 1.03;
    tube.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), random.uniform(-1, 1)});
  }
  EXPECT_LT(estimate_scale(tube).noise, 1e-4);
}

TEST(EstimateScale, FindsTheSpacing) {
  const std::size_t count = 8000;
  const Scale scale = estimate_scale(sphere_cloud(count, 1.0, 0.0));
  EXPECT_NEAR(scale.spacing, std::sqrt(4.0 * std::numbers::pi / static_cast<double>(count)), 0.1 * scale.spacing);
  EXPECT_NEAR(scale.diagonal, 2.0 * std::sqrt(3.0), 0.02);
}

TEST(EstimateScale, DoesNotDependOnUnitAndOrigin) {
  const PointCloud cloud = sphere_cloud(3000, 1.0, 0.01);
  const Scale scale = estimate_scale(cloud);
  for (const double factor : {0.01, 10'000.0}) {
    const Scale other = estimate_scale(moved(cloud, factor, {1e6, -1e6, 1e6}));
    EXPECT_NEAR(other.noise, factor * scale.noise, 1e-4 * other.noise);
    EXPECT_NEAR(other.spacing, factor * scale.spacing, 1e-4 * other.spacing);
    EXPECT_NEAR(other.diagonal, factor * scale.diagonal, 1e-4 * other.diagonal);
  }
}

TEST(EstimateScale, LeavesStrayPointsOutOfTheBox) {
  PointCloud cloud = sphere_cloud(3000, 1.0, 0.0);
  const double diagonal = estimate_scale(cloud).diagonal;
  cloud.positions.push_back({500, 0, 0});
  cloud.positions.push_back({0, -80, 3});
  EXPECT_NEAR(estimate_scale(without_normals(cloud)).diagonal, diagonal, 1e-9);
}

TEST(EstimateScale, IsTheSameOnAnyNumberOfThreads) {
  const PointCloud cloud = sphere_cloud(3000, 1.0, 0.01);
  EXPECT_EQ(estimate_scale(cloud, {.threads = 1}).noise, estimate_scale(cloud, {.threads = 2}).noise);
}

TEST(EstimateScale, RefusesTooFewPointsAndPointsAtOnePlace) {
  EXPECT_THROW((void)estimate_scale(sphere_cloud(9, 1.0, 0.0)), Error);
  EXPECT_THROW((void)estimate_scale(moved(sphere_cloud(50, 1.0, 0.0), 0.0, {1, 2, 3})), Error);
}

}  // namespace
}  // namespace cloud2csg
