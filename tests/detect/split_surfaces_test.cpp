#include "raw/detect/split_surfaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "core/base/random.hpp"
#include "raw/detect/two_surfaces.hpp"

namespace cloud2csg {
namespace {

constexpr double k_noise = 0.001;
constexpr std::size_t k_points = 3000;

/// Points at random on the unit square of a surface through the middle of the cloud, displaced along its normal.
struct Patch {
  WorkCloud cloud;
  GrownSurface grown;
};

using Height = std::function<double(double, double)>;

Surface flat() {
  return {.type = SurfaceType::plane};
}

Surface bent() {
  return {.type = SurfaceType::cylinder, .position = {0, 0, -1}, .axis = Eigen::Vector3d::UnitY(), .radius = 1};
}

/// `height`: of the surface's place with coordinates -1/2 to 1/2, in standard deviations of the noise.
Patch make_patch(const Surface& surface, const Height& height, std::uint64_t seed, std::size_t points = k_points,
                 double width = 1) {
  RandomStream random(seed);
  PointCloud cloud;
  for (std::size_t k = 0; k < points; ++k) {
    const double x = width * random.uniform(-0.5, 0.5);
    const double y = width * random.uniform(-0.5, 0.5);
    const double rise = k_noise * (height(x, y) + random.normal());
    const bool is_flat = surface.type == SurfaceType::plane;
    const Eigen::Vector3d normal = is_flat ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(std::sin(x), 0, std::cos(x));
    const Eigen::Vector3d foot = is_flat ? Eigen::Vector3d(x, y, 0) : Eigen::Vector3d(normal.x(), y, normal.z() - 1);
    cloud.positions.push_back(foot + rise * normal);
    cloud.normals.push_back(normal);
  }
  Patch patch{.cloud = make_work_cloud(cloud), .grown = {}};
  // Undo the scaling, so that the surface and the noise are the given ones.
  for (OrientedPoint& point : patch.cloud.points) {
    point.position = point.position * patch.cloud.diagonal + patch.cloud.middle;
  }
  patch.grown = {.surface = surface, .points = {}, .reach = k_deviations * k_noise};
  for (std::uint32_t i = 0; i < patch.cloud.size(); ++i) patch.grown.points.push_back(i);
  return patch;
}

SearchLimits limits_by(double noise) {
  return {.agreement = {.distance = k_deviations * k_noise, .noise = noise, .cosine = 0.9},
          .link = 0.1,
          .least_points = 15};
}

std::vector<GrownSurface> split(const Patch& patch, double noise = k_noise) {
  return split_surfaces({patch.grown}, patch.cloud, limits_by(noise), {.threads = 2});
}

// Seeds are fixed, because noise can look like anything, though rarely.
constexpr std::uint64_t k_seeds = 20;
constexpr std::uint64_t k_few_seeds = 8;  // where each takes long

TEST(SplitSurfaces, NoiseIsNoStep) {
  const Height none = [](double, double) { return 0.0; };
  for (std::uint64_t seed = 1; seed <= k_seeds; ++seed) {
    EXPECT_EQ(split(make_patch(flat(), none, seed)).size(), 1U);
    EXPECT_EQ(split(make_patch(bent(), none, seed)).size(), 1U);
  }
}

/// Neighbours in space are points with similar errors there.
TEST(SplitSurfaces, NoiseOfSeveralSpacingsIsNoStep) {
  const Height none = [](double, double) { return 0.0; };
  for (std::uint64_t seed = 1; seed <= k_seeds; ++seed) {
    for (const double spacings : {2.0, 3.0}) {
      const double width = k_noise / spacings * std::sqrt(static_cast<double>(k_points));
      EXPECT_EQ(split(make_patch(flat(), none, seed, k_points, width)).size(), 1U) << spacings << " spacings, " << seed;
    }
  }
}

TEST(SplitSurfaces, GradualFormErrorsAreNoSteps) {
  const Height bulge = [](double x, double y) { return 6 * (x * x + x * y - y * y); };
  const Height rounded_edge = [](double x, double) { return x > 0.4 ? -250 * (x - 0.4) * (x - 0.4) : 0.0; };
  for (std::uint64_t seed = 1; seed <= k_seeds; ++seed) {
    for (const Height& height : {bulge, rounded_edge}) {
      EXPECT_EQ(split(make_patch(flat(), height, seed)).size(), 1U);
      EXPECT_EQ(split(make_patch(bent(), height, seed)).size(), 1U);
    }
  }
}

bool is_high(double x, double y) {
  return std::abs(x) < 0.2 && std::abs(y) < 0.25;
}

/// Facets of a round surface would pass for steps.
TEST(SplitSurfaces, LeavesARoundSurfaceAloneThatScattersMoreThanTheNoise) {
  const Height step = [](double x, double y) { return is_high(x, y) ? 5.0 : 0.0; };
  EXPECT_EQ(split(make_patch(bent(), step, 1), k_noise).size(), 2U);
  EXPECT_EQ(split(make_patch(bent(), step, 1), k_noise / 2).size(), 1U);
  EXPECT_EQ(split(make_patch(flat(), step, 1), k_noise / 2).size(), 2U);
}

/// One of many runs is as far off by chance.
TEST(SplitSurfaces, LooksNoFurtherWhereNoRunOfPointsIsClearlyOff) {
  Patch patch = make_patch(
      flat(), [](double, double) { return 0.0; }, 1);
  const auto has_run_at = [&](double height) {
    for (std::uint32_t i = 0; i < patch.cloud.size(); ++i) {
      patch.cloud.points[i].position.z() = k_noise * ((i % 2 == 0 ? 1 : -1) + (i < 2 * k_nearest ? height : 0.0));
    }
    const std::vector<bool> is_free(patch.cloud.size(), false);
    return near_points(patch.grown, patch.cloud, is_free, limits_by(k_noise), {}).has_value();
  };
  EXPECT_FALSE(has_run_at(1.1));
  EXPECT_TRUE(has_run_at(1.5));
}

/// How many of these points are on the given side of the step.
double count_on_side(const std::vector<std::uint32_t>& points, const Patch& patch, bool high) {
  return static_cast<double>(std::ranges::count_if(points, [&](std::uint32_t i) {
    const Eigen::Vector3d& p = patch.cloud.points[i].position;
    const double x = patch.grown.surface.type == SurfaceType::plane ? p.x() : std::asin(p.x());
    return is_high(x, p.y()) == high;
  }));
}

void expect_step(const Surface& surface, double rise, std::uint64_t seed) {
  const Patch patch = make_patch(
      surface, [&](double x, double y) { return is_high(x, y) ? rise : 0; }, seed);
  const std::vector<GrownSurface> parts = split(patch);
  ASSERT_EQ(parts.size(), 2U) << rise << " standard deviations, seed " << seed;
  for (const bool high : {false, true}) {
    const GrownSurface& part = parts[high ? 1 : 0];
    EXPECT_EQ(part.surface.type, surface.type);
    const double right = count_on_side(part.points, patch, high);
    EXPECT_GT(right, 0.8 * count_on_side(patch.grown.points, patch, high));
    EXPECT_GT(right, 0.8 * static_cast<double>(part.points.size()));
  }
  EXPECT_GT(parts[0].points.size() + parts[1].points.size(), k_points * 97 / 100);
  std::vector<std::uint32_t> common;
  std::ranges::set_intersection(parts[0].points, parts[1].points, std::back_inserter(common));
  EXPECT_TRUE(common.empty());
}

TEST(SplitSurfaces, LooksNoFurtherWithTooFewPoints) {
  const Height off = [](double, double) { return 2.0; };
  SearchLimits limits = limits_by(k_noise);
  limits.least_points = 4;
  for (std::size_t points = k_nearest; points < 4 * k_nearest; ++points) {
    const Patch patch = make_patch(flat(), off, points, points);
    const std::vector<bool> is_free(points, false);
    const auto near = near_points(patch.grown, patch.cloud, is_free, limits, {});
    EXPECT_EQ(near.has_value(), points >= 2 * k_nearest) << points;
    if (near) {
      EXPECT_GE(near->neighbours.width, k_nearest);
    }
  }
}

TEST(SplitSurfaces, StepsAreFoundWhereTheyAre) {
  for (std::uint64_t seed = 1; seed <= k_seeds; ++seed) {
    for (const double rise : {-5.0, -3.0, -2.0, 2.0, 3.0, 5.0}) {
      expect_step(flat(), rise, seed);
      expect_step(bent(), rise, seed);
    }
  }
}

TEST(SplitSurfaces, HighStepsAreFoundWhereTheyAre) {
  for (std::uint64_t seed = 1; seed <= k_few_seeds; ++seed) {
    for (const double rise : {-30.0, 15.0}) {
      expect_step(flat(), rise, seed);
      expect_step(bent(), rise, seed);
    }
  }
}

/// The one surface is tilted between the halves.
TEST(SplitSurfaces, HalvesOfAFaceAreFoundFromOneStandardDeviationOn) {
  constexpr std::size_t k_many_points = 4000;
  for (std::uint64_t seed = 1; seed <= k_few_seeds; ++seed) {
    for (const double rise : {1.0, 2.0, 3.0}) {
      Patch patch = make_patch(
          flat(), [&](double x, double) { return x > 0 ? rise : 0; }, seed, k_many_points);
      patch.grown.surface.position.z() = rise * k_noise / 2;
      patch.grown.surface.axis = Eigen::Vector3d(-1.5 * rise * k_noise, 0, 1).normalized();
      const std::vector<GrownSurface> parts = split(patch);
      ASSERT_EQ(parts.size(), 2U) << rise << " standard deviations, seed " << seed;
      for (const GrownSurface& part : parts) {
        const auto right =
            std::ranges::count_if(part.points, [&](std::uint32_t i) { return patch.cloud.points[i].position.x() > 0; });
        const double share = static_cast<double>(right) / static_cast<double>(part.points.size());
        EXPECT_GT(std::max(share, 1 - share), 0.9) << rise << " standard deviations, seed " << seed;
        EXPECT_LT((part.surface.axis - Eigen::Vector3d::UnitZ()).norm(), rise * k_noise / 2);
      }
    }
  }
}

TEST(SplitSurfaces, FreePointsNearbyAreAStep) {
  Patch patch = make_patch(
      flat(), [](double x, double y) { return is_high(x, y) ? 6 : 0; }, 1);
  std::erase_if(patch.grown.points, [&](std::uint32_t i) {
    return signed_distance(flat(), patch.cloud.points[i].position) > k_deviations * k_noise;
  });
  const std::vector<GrownSurface> parts = split(patch);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_GT(parts[1].points.size(), k_points * 18 / 100);
}

}  // namespace
}  // namespace cloud2csg
