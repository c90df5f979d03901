#include "core/geometry/spatial_order.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/base/random.hpp"
#include "support/properties.hpp"

namespace cloud2csg {
namespace {

std::vector<std::uint32_t> all_indices(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

std::vector<std::uint32_t> order_of(const Points& points, int threads = 1) {
  return spatial_order(points, bounds_of(points), {.threads = threads});
}

void expect_permutation(std::vector<std::uint32_t> order, std::size_t count) {
  std::ranges::sort(order);
  EXPECT_EQ(order, all_indices(count));
}

/// Evenly in a box; some of the extents may be zero.
Points random_points(std::size_t count, const Eigen::Vector3d& extent, RandomStream& random) {
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(-extent.x(), extent.x());
    const double y = random.uniform(-extent.y(), extent.y());
    points.push_back({x, y, random.uniform(-extent.z(), extent.z())});
  }
  return points;
}

double mean_step(const Points& points, const std::vector<std::uint32_t>& order) {
  double sum = 0;
  for (std::size_t i = 1; i < order.size(); ++i) sum += (points[order[i]] - points[order[i - 1]]).norm();
  return sum / static_cast<double>(order.size() - 1);
}

RC_GTEST_PROP(SpatialOrder, IsAPermutation, (std::uint64_t seed)) {
  RandomStream random(seed);
  Eigen::Vector3d extent(random.uniform(0.01, 100), random.uniform(0.01, 100), random.uniform(0.01, 100));
  for (int axis = 0; axis < 3; ++axis) {
    if (random.chance(0.2)) extent[axis] = 0;
  }
  const std::size_t count = random.below(3000);
  expect_permutation(order_of(random_points(count, extent, random)), count);
  test::fail_property_when_failed();
}

/// Several chunks of keys, and points that fall into one cell: these stay in their order.
TEST(SpatialOrder, DoesNotDependOnThreads) {
  RandomStream random(3);
  Points points = random_points(150'000, {5, 5, 5}, random);
  for (std::size_t i = 0; i < 20'000; ++i) points.push_back({1, 1, 1});
  const std::vector<std::uint32_t> expected = order_of(points);
  expect_permutation(expected, points.size());
  for (const int threads : {2, 3, 8, 0}) EXPECT_EQ(order_of(points, threads), expected) << threads;
}

TEST(SpatialOrder, BringsNeighboursTogether) {
  RandomStream random(5);
  // The nearest of 20'000 points in a cube of side 2 are some 0.04 away, random ones 1.3; in a plane 0.01 and 1.
  for (const Eigen::Vector3d& extent : {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(0, 1, 0)}) {
    const Points points = random_points(20'000, extent, random);
    EXPECT_LT(mean_step(points, order_of(points)), 0.1 * mean_step(points, all_indices(points.size())));
  }
}

/// Whole blocks of the order are small, too, whatever the cloud's place and scale.
TEST(SpatialOrder, MakesSmallBlocks) {
  RandomStream random(7);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    Points points = random_points(16'384, {scale, scale, scale}, random);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points.set(i, points[i] + Eigen::Vector3d(100 * scale, -50 * scale, 0));
    }
    const std::vector<std::uint32_t> order = order_of(points);
    double volume = 0;
    for (std::size_t begin = 0; begin < order.size(); begin += 256) {
      AlignedBox box;
      for (std::size_t i = begin; i < begin + 256; ++i) box.extend(points[order[i]]);
      volume += box.volume();
    }
    EXPECT_LT(volume, 4 * bounds_of(points).volume()) << scale;  // there are 64 blocks
  }
}

/// Cells of an octree are runs along the curve.
RC_GTEST_PROP(MortonCurve, NestsItsCells, (std::uint64_t seed)) {
  RandomStream random(seed);
  const Points corner = random_points(1, {10, 10, 10}, random);
  const double edge = random.uniform(0.1, 10);
  const MortonCurve fine(corner[0], edge, MortonCurve::k_most_bits);
  const Points points = random_points(50, {20, 20, 20}, random);  // in the cube and around it
  for (int bits = 1; bits < fine.bits(); ++bits) {
    const MortonCurve coarse(corner[0], edge, bits);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint32_t cell = fine.cell_of(points.x[i], points.y[i], points.z[i]);
      const std::uint32_t around = coarse.cell_of(points.x[i], points.y[i], points.z[i]);
      const std::uint32_t coarsened = cell >> static_cast<unsigned>(3 * (fine.bits() - bits));
      RC_ASSERT(coarsened == around);
    }
  }
}

TEST(SpatialOrder, KeepsThatOfEqualPoints) {
  Points points;
  for (int i = 0; i < 1000; ++i) points.push_back({0.3, -7, 1e9});
  EXPECT_EQ(order_of(points), all_indices(1000));
  EXPECT_EQ(order_of(points, 3), all_indices(1000));
}

TEST(SpatialOrder, TakesOnePointOrNone) {
  Points points;
  EXPECT_TRUE(order_of(points).empty());
  points.push_back({1, 2, 3});
  EXPECT_EQ(order_of(points), all_indices(1));
}

/// The least extents that doubles have, and a box that is larger than the points.
TEST(SpatialOrder, TakesExtremeBoxes) {
  RandomStream random(9);
  const Points tiny = random_points(500, {1e-310, 0, 1e-310}, random);
  expect_permutation(order_of(tiny), 500);
  const Points points = random_points(500, {1, 1, 1}, random);
  const AlignedBox wide(Eigen::Vector3d::Constant(-1e12), Eigen::Vector3d::Constant(1e12));
  expect_permutation(spatial_order(points, wide), 500);
}

}  // namespace
}  // namespace cloud2csg
