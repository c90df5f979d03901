#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "sample/solids.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;
using Eigen::Matrix3d;
using Eigen::Vector3d;

PointCloud sample(const KnownSolid& solid, const SampleOptions& options = {}) {
  return sample_surface(solid.model(), options);
}

std::vector<KnownSolid> all_solids() {
  std::vector<KnownSolid> solids = plain_solids();
  std::ranges::copy(combined_solids(), std::back_inserter(solids));
  std::ranges::copy(cut_cubes(), std::back_inserter(solids));
  std::ranges::copy(field_solids(), std::back_inserter(solids));
  return solids;
}

Points moved_along_normals(const PointCloud& cloud, double distance) {
  Points moved(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) moved.set(i, cloud.positions[i] + distance * cloud.normals[i]);
  return moved;
}

TEST(SampleSurface, PointsLieOnTheSurface) {
  for (const KnownSolid& solid : all_solids()) {
    const PointCloud cloud = sample(solid, {.count = 3000});
    ASSERT_EQ(cloud.size(), 3000U) << solid.name;
    ASSERT_EQ(cloud.normals.size(), 3000U) << solid.name;
    for (const double value : implicit_value(solid.tree, solid.primitives, cloud.positions)) {
      ASSERT_NEAR(value, 0.0, 1e-10) << solid.name;
    }
  }
}

TEST(SampleSurface, NormalsAreOfUnitLengthAndPointOutward) {
  for (const KnownSolid& solid : all_solids()) {
    const PointCloud cloud = sample(solid, {.count = 3000});
    const std::vector<double> outer = implicit_value(solid.tree, solid.primitives, moved_along_normals(cloud, 1e-5));
    const std::vector<double> inner = implicit_value(solid.tree, solid.primitives, moved_along_normals(cloud, -1e-5));
    int wrong = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_NEAR(cloud.normals[i].norm(), 1.0, 1e-12) << solid.name;
      wrong += outer[i] > 0.0 && inner[i] < 0.0 ? 0 : 1;
    }
    EXPECT_LE(wrong, 3) << solid.name;  // a point may lie within 1e-5 of an edge
  }
}

/// By the divergence theorem the mean of x n^T over a closed surface is (volume / area) times the identity, and the
/// mean of n is zero. Both fail when any part of the surface is drawn too often, too seldom or not at all.
TEST(SampleSurface, IsUniformByArea) {
  constexpr std::size_t k_count = 60'000;
  for (const KnownSolid& solid : all_solids()) {
    const PointCloud cloud = sample(solid, {.count = k_count});
    const Vector3d centre = bounds_of(cloud.positions.view()).center();
    Vector3d mean_normal = Vector3d::Zero();
    Matrix3d mean_product = Matrix3d::Zero();
    double reach = 0.0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vector3d position = cloud.positions[i] - centre;
      mean_normal += cloud.normals[i] / k_count;
      mean_product += position * cloud.normals[i].transpose() / k_count;
      reach = std::max(reach, position.norm());
    }
    const double tolerance = 5.0 / std::sqrt(k_count);
    EXPECT_LT(mean_normal.norm(), tolerance) << solid.name;
    const Matrix3d expected = solid.volume / solid.area * Matrix3d::Identity();
    EXPECT_LT((mean_product - expected).norm(), tolerance * reach) << solid.name << "\n" << mean_product;
  }
}

TEST(SampleSurface, PartsGetTheirShareOfTheArea) {
  const KnownSolid holed = combined_solids()[0];
  const PointCloud cloud = sample(holed, {.count = 40'000});
  double on_sphere = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::abs(cloud.positions[i].norm() - 0.8) > 1e-9) continue;
    ++on_sphere;
    EXPECT_LT(cloud.normals[i].dot(cloud.positions[i]), 0.0);  // out of the solid is into the hole
  }
  EXPECT_NEAR(on_sphere / 40'000, 4 * std::numbers::pi * 0.64 / holed.area, 0.01);
}

TEST(SampleSurface, DensityGivesThePointsOfTheArea) {
  std::vector<KnownSolid> solids = combined_solids();
  std::ranges::copy(cut_cubes(), std::back_inserter(solids));
  for (const KnownSolid& solid : solids) {
    const PointCloud cloud = sample(solid, {.density = 1000.0});
    EXPECT_NEAR(static_cast<double>(cloud.size()), 1000.0 * solid.area, 0.01 * 1000.0 * solid.area) << solid.name;
  }
}

TEST(SampleSurface, SameSeedSameCloudForAnyNumberOfThreads) {
  const KnownSolid solid = combined_solids()[5];
  const SampleOptions options{.count = 30'000, .noise = 0.01, .normal_noise_deg = 2.0, .seed = 7};
  const PointCloud one = sample_surface(solid.model(), options, {.threads = 1});
  const PointCloud many = sample_surface(solid.model(), options, {.threads = 4});
  EXPECT_EQ(one.positions.x, many.positions.x);
  EXPECT_EQ(one.positions.z, many.positions.z);
  EXPECT_EQ(one.normals.y, many.normals.y);
  const PointCloud other = sample(solid, {.count = 30'000, .noise = 0.01, .normal_noise_deg = 2.0, .seed = 8});
  EXPECT_NE(one.positions.x, other.positions.x);
}

TEST(SampleSurface, NoiseHasItsSigmaInEveryCoordinate) {
  const KnownSolid solid = plain_solids()[0];
  const PointCloud clean = sample(solid, {.count = 20'000});
  const PointCloud noisy = sample(solid, {.count = 20'000, .noise = 0.05});
  EXPECT_EQ(clean.normals.x, noisy.normals.x);
  Vector3d mean = Vector3d::Zero();
  Matrix3d covariance = Matrix3d::Zero();
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const Vector3d shift = noisy.positions[i] - clean.positions[i];
    mean += shift / 20'000;
    covariance += shift * shift.transpose() / 20'000;
  }
  EXPECT_LT(mean.norm(), 0.002);
  EXPECT_LT((covariance - 0.0025 * Matrix3d::Identity()).norm(), 0.0002);
}

TEST(SampleSurface, NormalNoiseHasItsSigma) {
  const KnownSolid solid = plain_solids()[1];
  const PointCloud clean = sample(solid, {.count = 20'000});
  const PointCloud noisy = sample(solid, {.count = 20'000, .normal_noise_deg = 5.0});
  EXPECT_EQ(clean.positions.x, noisy.positions.x);
  double squares = 0.0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    ASSERT_NEAR(noisy.normals[i].norm(), 1.0, 1e-12);
    const double angle =
        std::atan2(clean.normals[i].cross(noisy.normals[i]).norm(), clean.normals[i].dot(noisy.normals[i]));
    squares += std::pow(angle * 180 / std::numbers::pi, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / 20'000), 5.0, 0.15);
}

TEST(SampleSurface, DisplacedSolidsAreFollowed) {
  Primitive bumpy = at("a", Box{{4, 4, 4}}, {0, 0, 0});
  bumpy.displacement = Displacement{.frequency = 3.0};
  const PrimitiveSet primitives{bumpy};
  const PointCloud cloud = sample_surface({.primitives = primitives, .tree = CsgTree::leaf(0)}, {.count = 3000});
  double farthest = 0.0;
  for (const double value : signed_distance(bumpy, cloud.positions)) ASSERT_NEAR(value, 0.0, 1e-10);
  for (const double value : signed_distance(at("a", Box{{4, 4, 4}}, {0, 0, 0}), cloud.positions)) {
    farthest = std::max(farthest, std::abs(value));
  }
  EXPECT_GT(farthest, 0.3);
}

void expect_refused(const CsgTree& tree, const PrimitiveSet& primitives, const SampleOptions& options,
                    const std::string& where, const std::string& expected) {
  try {
    (void)sample_surface({.primitives = primitives, .tree = tree}, options);
    FAIL() << "no error: " << expected;
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().where, where);
    EXPECT_NE(error.parts().expected.find(expected), std::string::npos) << error.what();
  }
}

TEST(SampleSurface, RefusesEmptyAndUnboundedSolids) {
  const CsgTree a = CsgTree::leaf(0);
  const PrimitiveSet primitives{at("a", Sphere{1}, {0, 0, 0}), at("h", HalfSpace{}, {0, 0, 0})};
  expect_refused(CsgTree::empty(), primitives, {}, "tree", "empty");
  expect_refused(intersect(a, complement(a)), primitives, {}, "tree", "empty");
  expect_refused(CsgTree::full(), primitives, {}, "tree", "unbounded");
  expect_refused(complement(a), primitives, {}, "tree", "unbounded");
  expect_refused(CsgTree::leaf(1), primitives, {}, "tree", "unbounded");
}

TEST(SampleSurface, RefusesBadOptionsByName) {
  const PrimitiveSet primitives{at("a", Sphere{1}, {0, 0, 0})};
  expect_refused(CsgTree::leaf(0), primitives, {.count = 0}, "count", "at least one");
  expect_refused(CsgTree::leaf(0), primitives, {.density = -1}, "density", "0 or more");
  expect_refused(CsgTree::leaf(0), primitives, {.noise = NAN}, "noise", "0 or more");
  expect_refused(CsgTree::leaf(0), primitives, {.normal_noise_deg = INFINITY}, "normal_noise_deg", "0 or more");
}

TEST(SampleSurface, HonoursTheStopToken) {
  std::stop_source stop;
  stop.request_stop();
  const KnownSolid solid = plain_solids()[0];
  EXPECT_THROW((void)sample_surface(solid.model(), {}, {.stop = stop.get_token()}), Cancelled);
}

}  // namespace
}  // namespace cloud2csg
