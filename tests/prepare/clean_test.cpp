#include <gtest/gtest.h>

#include <numbers>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/error.hpp"
#include "core/geometry/subset.hpp"
#include "prepare/clouds.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

double share_lost(const PointCloud& cloud) {
  const CleanCloud clean = clean_cloud(cloud, estimate_scale(cloud));
  return 1.0 - static_cast<double>(clean.cloud.size()) / static_cast<double>(cloud.size());
}

/// A plate with thickness of some spacings, and a sparse box beside it.
PointCloud thin_and_sparse() {
  PointCloud cloud;
  RandomStream random(5);
  add_box(cloud, {0, 0, 0}, {1, 1, 0.12}, 1000, false, random);
  add_box(cloud, {2, 0, 0}, {3, 1, 1}, 200, false, random);
  return cloud;
}

TEST(CleanCloud, KeepsThinWallsEdgesAndSparseRegions) {
  EXPECT_LT(share_lost(thin_and_sparse()), 0.005);
  EXPECT_LT(share_lost(model_cloud("m2", 6000, 0.002)), 0.005);
}

/// From the faces of a box that starts at the origin; negative inside.
double distance_to_box(const Vector3d& place, const Vector3d& size) {
  const Vector3d beyond = (place - size / 2).cwiseAbs() - size / 2;
  return beyond.cwiseMax(0.0).norm() + std::min(0.0, beyond.maxCoeff());
}

/// A box, and as many outliers, which have no normals.
PointCloud box_among_outliers(const Vector3d& size, double noise) {
  RandomStream random(3);
  PointCloud cloud;
  add_box(cloud, Vector3d::Zero(), size, 3000, false, random);
  cloud = with_noise(std::move(cloud), noise);
  const std::size_t points = cloud.size();
  for (std::size_t i = 0; i < points; ++i) {
    const Vector3d share(random.uniform(-0.05, 1.05), random.uniform(-0.05, 1.05), random.uniform(-0.05, 1.05));
    cloud.positions.push_back(share.cwiseProduct(size));
    cloud.normals.push_back(Vector3d::Zero());
  }
  return cloud;
}

TEST(CleanCloud, LeavesOutOrDoubtsUniformOutliers) {
  const Vector3d size(1, 0.8, 0.4);
  const double noise = 0.0015;
  const PointCloud cloud = box_among_outliers(size, noise);
  const std::size_t points = cloud.size() / 2;
  const auto count_far = [&](const PointCloud& some) {
    double far = 0.0;
    for (std::size_t i = 0; i < some.size(); ++i) {
      far += some.normals[i].isZero() && std::abs(distance_to_box(some.positions[i], size)) > 5.0 * noise ? 1.0 : 0.0;
    }
    return far;
  };
  const CleanCloud clean = clean_cloud(cloud, estimate_scale(cloud));
  const PointCloud sure = without_points(clean.cloud, clean.doubted);
  EXPECT_LT(count_far(sure), 0.05 * count_far(cloud));
  std::size_t outliers = 0;
  for (std::size_t i = 0; i < sure.size(); ++i) outliers += sure.normals[i].isZero() ? 1 : 0;
  EXPECT_GT(sure.size() - outliers, points - points / 200);
  EXPECT_EQ(clean.report.isolated + clean.report.off_surface, cloud.size() - clean.cloud.size());
}

/// From far away a rod is a line, and every outlier is on a plane through it.
TEST(CleanCloud, LeavesOutFewOutliersAroundAThinRod) {
  PointCloud cloud;
  RandomStream random(8);
  for (int i = 0; i < 60'000; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double radius = 0.25 + 0.005 * random.normal();
    cloud.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), random.uniform(-5, 5)});
  }
  for (int i = 0; i < 240; ++i) {
    cloud.positions.push_back({random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)});
  }
  const PointCloud clean = prepare_cloud(cloud).cloud;
  EXPECT_GE(clean.size(), 59'900U);
  for (std::size_t i = 0; i < clean.size(); ++i) EXPECT_LT(clean.positions[i].head<2>().norm(), 0.5);
}

TEST(CleanCloud, ThinsDoubtedPointsFirst) {
  const PointCloud cloud = box_among_outliers({1, 0.8, 0.4}, 0.0015);
  const Scale scale = estimate_scale(cloud);
  const CleanCloud all = clean_cloud(cloud, scale);
  const std::size_t sure = all.cloud.size() - all.doubted.size();
  const CleanCloud thin = clean_cloud(cloud, scale, {.point_budget = sure / 2});
  EXPECT_LE(thin.cloud.size() - thin.doubted.size(), sure / 2);
  EXPECT_GT(thin.cloud.size() - thin.doubted.size(), sure / 3);
}

TEST(PrepareCloud, KeepsGoodNormalsAmongOutliers) {
  PointCloud cloud = box_among_outliers({1, 0.8, 0.4}, 0.0015);
  RandomStream random(4);
  for (std::size_t i = cloud.size() / 2; i < cloud.size(); ++i) {
    cloud.normals.set(i, Vector3d(random.normal(), random.normal(), random.normal()).normalized());
  }
  EXPECT_FALSE(prepare_cloud(cloud).normals_estimated);
}

/// Its points are on no plane of their neighbours, but dense.
TEST(CleanCloud, KeepsABoreOfAFewSpacings) {
  constexpr double k_radius = 0.05;  // one and a half spacings
  constexpr std::size_t k_points = 126;
  RandomStream random(7);
  PointCloud cloud;
  add_box(cloud, {-1, -1, -0.2}, {1, 1, 0.2}, 1000, false, random);
  std::vector<bool> is_outside(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) is_outside[i] = cloud.positions[i].head<2>().norm() > k_radius;
  cloud = select_points(cloud, places_where(is_outside, true));
  const std::size_t faces = cloud.size();
  for (std::size_t i = 0; i < k_points; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const Vector3d normal(-std::cos(angle), -std::sin(angle), 0);
    cloud.positions.push_back(-k_radius * normal + random.uniform(-0.2, 0.2) * Vector3d::UnitZ());
    cloud.normals.push_back(normal);
  }
  const CleanCloud clean = clean_cloud(cloud, estimate_scale(cloud));
  EXPECT_GE(clean.cloud.size(), faces + k_points - k_points / 20);
}

TEST(CleanCloud, CountsDuplicates) {
  PointCloud cloud = sphere_cloud(500, 1.0, 0.0);
  for (std::size_t i = 0; i < 40; ++i) {
    cloud.positions.push_back(cloud.positions[i]);
    cloud.normals.push_back(cloud.normals[i]);
  }
  const CleanCloud clean = clean_cloud(cloud, estimate_scale(cloud), {.remove_outliers = false});
  EXPECT_EQ(clean.report.duplicates, 40U);
  EXPECT_EQ(clean.cloud.positions.x, sphere_cloud(500, 1.0, 0.0).positions.x);
}

TEST(CleanCloud, ThinsToTheBudgetButNotBeyondTheDetail) {
  const PointCloud cloud = sphere_cloud(9000, 1.0, 0.0);
  const Scale scale = estimate_scale(cloud);
  const CleanCloud half = clean_cloud(cloud, scale, {.remove_outliers = false, .point_budget = 4000});
  EXPECT_LE(half.cloud.size(), 4000U);
  EXPECT_GT(half.cloud.size(), 3000U);
  EXPECT_EQ(half.report.thinned, cloud.size() - half.cloud.size());
  EXPECT_EQ(half.cloud.normals.size(), half.cloud.size());
  const CleanCloud few = clean_cloud(cloud, scale, {.remove_outliers = false, .point_budget = 10});
  EXPECT_GT(few.cloud.size(), 500U);
}

TEST(CleanCloud, RefusesABudgetOfNothing) {
  const PointCloud cloud = sphere_cloud(100, 1.0, 0.0);
  EXPECT_THROW((void)clean_cloud(cloud, estimate_scale(cloud), {.point_budget = 0}), Error);
}

}  // namespace
}  // namespace cloud2csg
