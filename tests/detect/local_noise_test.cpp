#include "raw/detect/local_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "detect/detected_parts.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_quiet = 0.001;
constexpr AgreementLimits k_limits{.distance = 3 * k_quiet, .noise = k_quiet, .cosine = 0.9};

/// In the cloud's own units and place.
WorkCloud unscaled(const PointCloud& cloud) {
  WorkCloud work = make_work_cloud(cloud);
  for (OrientedPoint& point : work.points) point.position = point.position * work.diagonal + work.middle;
  work.runs = runs_of(work.points);
  return work;
}

constexpr double k_width = 0.7;

/// A square of height 0 or with steps. Noise is `ratio` times k_quiet where x is above 0.
template <class Height>
PointCloud square(double ratio, const Height& height) {
  RandomStream random(5);
  PointCloud cloud;
  for (int k = 0; k < 8000; ++k) {
    const double x = k_width * random.uniform(-0.5, 0.5);
    const double y = k_width * random.uniform(-0.5, 0.5);
    cloud.positions.push_back({x, y, height(x, y) + (x > 0 ? ratio : 1) * k_quiet * random.normal()});
    cloud.normals.push_back(Vector3d::UnitZ());
  }
  return cloud;
}

PointCloud flat_square(double ratio) {
  return square(ratio, [](double, double) { return 0; });
}

GrownSurface level_at(double height, const WorkCloud& work) {
  GrownSurface plane{.surface = {.type = SurfaceType::plane, .position = {0, 0, height}}, .points = {}};
  for_each_agreeing(
      plane.surface, work, k_limits, [](std::uint32_t) { return true; },
      [&](std::uint32_t i, const Agreement&) { plane.points.push_back(i); });
  return plane;
}

TEST(LocalNoise, IsMeasuredByPlace) {
  for (const double ratio : {3.0, 4.0}) {
    const WorkCloud work = unscaled(flat_square(ratio));
    const std::vector<double> noise = local_noise({level_at(0, work)}, work, k_limits, {});
    ASSERT_EQ(noise.size(), work.size());
    for (std::size_t i = 0; i < work.size(); ++i) {
      const double x = work.points[i].position.x();
      if (x < -0.1) {
        EXPECT_EQ(noise[i], 1);
      }
      if (x > 0.1) {
        EXPECT_NEAR(noise[i], ratio, 0.3 * ratio);
      }
    }
  }
}

TEST(LocalNoise, EndsWithThePlanesThatShowIt) {
  PointCloud cloud = flat_square(4);
  RandomStream random(6);
  for (int k = 0; k < 4000; ++k) {
    cloud.positions.push_back({k_width / 2, k_width * random.uniform(-0.5, 0.5), k_width * random.uniform(0, 1)});
    cloud.normals.push_back(Vector3d::UnitX());
  }
  const WorkCloud work = unscaled(cloud);
  const std::vector<double> noise = local_noise({level_at(0, work)}, work, k_limits, {});
  ASSERT_EQ(noise.size(), work.size());
  for (std::size_t i = 0; i < work.size(); ++i) {
    if (work.points[i].position.z() > k_width / 2) {
      EXPECT_EQ(noise[i], 1);
    }
  }
}

TEST(LocalNoise, IsThatOfTheLimits) {
  const WorkCloud work = unscaled(flat_square(1.6));
  EXPECT_TRUE(local_noise({level_at(0, work)}, work, k_limits, {}).empty());
}

TEST(LocalNoise, IsNotTheDetailOfOtherSurfaces) {
  constexpr double k_height = 8 * k_quiet;
  const WorkCloud ribbed =
      unscaled(square(1, [&](double x, double) { return std::fmod(x + 1, 0.08) < 0.04 ? k_height : 0; }));
  const GrownSurface low = level_at(0, ribbed);
  EXPECT_TRUE(local_noise({low, level_at(k_height, ribbed)}, ribbed, k_limits, {}).empty());
}

TEST(LocalNoise, IsNotTheWidthOfAWall) {
  for (const double half_width : {2.5, 3.0, 4.0}) {
    RandomStream random(7);
    PointCloud wall = flat_square(1);
    for (std::size_t i = 0; i < wall.size(); ++i) {
      const double side = random.uniform() < 0.5 ? -1 : 1;
      wall.positions.set(i, wall.positions[i] + side * half_width * k_quiet * Vector3d::UnitZ());
    }
    const WorkCloud work = unscaled(wall);
    EXPECT_TRUE(local_noise({level_at(0, work)}, work, k_limits, {}).empty()) << half_width;
  }
}

TEST(AccountForNoise, LowersPrecisionAndStraightensNormals) {
  constexpr double k_ratio = 10;
  WorkCloud work = unscaled(flat_square(k_ratio));
  std::vector<double> noise(work.size(), 1);
  RandomStream random(8);
  for (std::size_t i = 0; i < work.size(); ++i) {
    if (work.points[i].position.x() <= 0) continue;
    noise[i] = k_ratio;
    Vector3d& normal = work.points[i].normal;
    normal = (normal + 0.8 * test::random_direction(random)).normalized();
  }
  const std::vector<OrientedPoint> before = work.points;
  Scale scale;
  scale.spacing = k_width / std::sqrt(static_cast<double>(work.size())) * work.diagonal;
  scale.noise = k_quiet * work.diagonal;
  account_for_noise(work, noise, scale, {});
  std::size_t off = 0;
  for (std::size_t i = 0; i < work.size(); ++i) {
    EXPECT_EQ(work.points[i].precision, 1 / noise[i]);
    if (noise[i] == 1) {
      EXPECT_EQ(work.points[i].normal, before[i].normal);
    }
    if (noise[i] > 1 && work.points[i].normal.z() < 0.95) ++off;
  }
  EXPECT_LT(off, work.size() / 50);
  for (const PointRun& run : work.runs) EXPECT_LE(run.precision, work.points[run.first].precision);
}

/// How many times as noisy one half of a bar is as the other.
class NoisyHalf : public testing::TestWithParam<double> {};

/// Limits by the noise of the quiet half would leave many points of the other one, which became surfaces.
TEST_P(NoisyHalf, MakesNoSurfaces) {
  constexpr double k_least = 0.0065;
  PointCloud cloud = test::cloud_of(
      {.primitives = {test::placed("bar", Box{{4, 1.2, 1.2}}, {0, 0, 0})}, .tree = CsgTree::leaf(0)}, 0, 12'000);
  cloud.normals = {};
  RandomStream random(4);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d place = cloud.positions[i];
    const double noise = (place.x() > 0 ? GetParam() : 1) * k_least;
    cloud.positions.set(i, place + noise * Vector3d(random.normal(), random.normal(), random.normal()));
  }
  const PreparedCloud prepared = prepare_cloud(cloud);
  const Detection detection = detect_surfaces(prepared.cloud, prepared.scale);
  EXPECT_EQ(detection.surfaces.size(), 6U);
  EXPECT_EQ(test::count_of(detection, SurfaceType::plane), 6U);
  EXPECT_LT(detection.unexplained, prepared.cloud.size() / 15);
  EXPECT_LT(detection.noise, 1.5 * k_least);
  for (const DetectedSurface& s : detection.surfaces) {
    if (s.surface.axis.x() > 0.9) {
      EXPECT_NEAR(s.rms, GetParam() * k_least, 0.2 * GetParam() * k_least);
    }
    if (s.surface.axis.x() < -0.9) {
      EXPECT_NEAR(s.rms, k_least, 0.2 * k_least);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ratios, NoisyHalf, testing::Values(4, 8));

}  // namespace
}  // namespace cloud2csg
