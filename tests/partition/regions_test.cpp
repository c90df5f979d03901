#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/base/random.hpp"
#include "paper/partition/partitions.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

constexpr double k_unbounded = std::numeric_limits<double>::infinity();

std::vector<PrimitiveIndex> first_indices(std::size_t count) {
  std::vector<PrimitiveIndex> all(count);
  std::iota(all.begin(), all.end(), PrimitiveIndex{0});
  return all;
}

/// Small boxes in a large one; some are infinite.
std::vector<AlignedBox> random_boxes(std::size_t count, RandomStream& random) {
  std::vector<AlignedBox> boxes;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector3d middle = test::random_within(10, random);
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(random.uniform(0, 2));
    boxes.emplace_back(middle - half, middle + half);
    if (random.chance(0.05)) boxes.back().max().x() = k_unbounded;
  }
  return boxes;
}

bool holds(const AlignedBox& box, const Eigen::Vector3d& point) {
  return (point.array() >= box.min().array()).all() && (point.array() < box.max().array()).all();
}

RC_GTEST_PROP(Regions, CoverSpaceOnceAndKnowAllThatReachIntoThem, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::vector<AlignedBox> reach = random_boxes(random.below(80), random);
  std::vector<PrimitiveIndex> primitives = first_indices(reach.size());
  std::erase_if(primitives, [&](PrimitiveIndex /*p*/) { return random.chance(0.2); });
  const std::vector<Region> regions = cut_into_regions(primitives, reach, 1 + random.below(20));
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d point = test::random_within(14, random);
    const auto is_here = [&](const Region& region) { return holds(region.box, point); };
    RC_ASSERT(std::ranges::count_if(regions, is_here) == 1);
    const Region& here = *std::ranges::find_if(regions, is_here);
    RC_ASSERT(std::ranges::is_sorted(here.near));
    for (const PrimitiveIndex p : primitives) {
      RC_ASSERT(!reach[p].contains(point) || std::ranges::binary_search(here.near, p));
    }
  }
  for (const Region& region : regions) RC_ASSERT(std::ranges::includes(primitives, region.near));
}

TEST(Regions, HaveNoMoreThanTheLimitWhereBoxesCanBeParted) {
  std::vector<AlignedBox> reach;
  for (int k = 0; k < 400; ++k) {
    const int row = k / 20;
    const Eigen::Vector3d corner(k % 20, row, 0);
    reach.emplace_back(corner, corner + Eigen::Vector3d(0.6, 0.6, 5));
  }
  const std::vector<Region> regions = cut_into_regions(first_indices(400), reach, 12);
  EXPECT_LT(regions.size(), 120U);
  for (const Region& region : regions) EXPECT_LE(region.near.size(), 12U);
}

/// Long boxes that only cuts along them can part, though their middles are farther apart the other way.
TEST(Regions, AreCutAcrossTheAxisThatHelps) {
  std::vector<AlignedBox> reach;
  for (int k = 0; k < 100; ++k) {
    const double x = 0.1 * (k * 37 % 100);
    reach.emplace_back(Eigen::Vector3d(x - 15, 0.05 * k, 0), Eigen::Vector3d(x + 15, 0.05 * k + 0.02, 1));
  }
  for (const Region& region : cut_into_regions(first_indices(100), reach, 20)) EXPECT_LE(region.near.size(), 20U);
}

TEST(Regions, OfBoxesThatCannotBePartedAreFew) {
  const std::vector<AlignedBox> same(50, AlignedBox(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 1)));
  EXPECT_EQ(cut_into_regions(first_indices(50), same, 10).size(), 1U);
  const Eigen::Vector3d infinite = Eigen::Vector3d::Constant(k_unbounded);
  const std::vector<AlignedBox> everywhere(50, AlignedBox(-infinite, infinite));
  EXPECT_EQ(cut_into_regions(first_indices(50), everywhere, 10).size(), 1U);
  EXPECT_EQ(cut_into_regions({}, everywhere, 10).size(), 1U);
}

}  // namespace
}  // namespace cloud2csg
