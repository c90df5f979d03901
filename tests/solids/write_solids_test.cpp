#include "raw/solids/write_solids.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "cloud2csg/sample.hpp"
#include "raw/solids/bare_surface.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

constexpr double k_tolerance = 0.02;

/// A bar along x, centred at the origin, with a ball on its end at -x.
WrittenSolids bar_of(double length) {
  return {.solids = {test::placed("bar", Box{{length, 1, 1}}, {0, 0, 0}), test::placed("ball", Sphere{1}, {-2, 0, 0})},
          .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
}

Points surface_of(const WrittenSolids& written) {
  const Model model{.primitives = written.solids, .tree = written.tree};
  return sample_surface(model, {.count = 20'000, .seed = 1}).positions;
}

/// The written solid without what sticks out of these points.
WrittenSolids cut(const WrittenSolids& written, const Points& points) {
  return without_what_sticks_out(written, bounds_of(points), points, k_tolerance);
}

TEST(WithoutWhatSticksOut, EndsTheSolidWhereThePointsEnd) {
  const Points points = surface_of(bar_of(4));
  const WrittenSolids shorter = cut(bar_of(5), points);
  ASSERT_EQ(shorter.solids.size(), 3U);
  EXPECT_EQ(shorter.solids[2].id, "box_0");
  const AlignedBox reached = bounds_of(surface_of(shorter));
  EXPECT_NEAR(reached.max().x(), bounds_of(points).max().x() + k_tolerance, 1e-6);
  EXPECT_NEAR(reached.min().x(), -3, 0.01) << "the ball stays as it is";
  EXPECT_NEAR(reached.max().z(), 1, 0.01);
}

TEST(WithoutWhatSticksOut, DoesNotMindStrays) {
  Points points = surface_of(bar_of(4));
  const AlignedBox seen = bounds_of(points);
  points.push_back({2.6, 0, 0});
  EXPECT_EQ(without_what_sticks_out(bar_of(5), seen, points, k_tolerance).solids.size(), 3U);
}

TEST(WithoutWhatSticksOut, LeavesASolidWithinTheBoundsAlone) {
  const Points points = surface_of(bar_of(4));
  const WrittenSolids same = cut(bar_of(4 + 2 * k_tolerance), points);
  EXPECT_EQ(same.solids.size(), 2U);
  EXPECT_EQ(same.tree, bar_of(4).tree);
}

/// Its corners are farther than two tolerances from all points, but not beyond any side.
TEST(WithoutWhatSticksOut, AddsNoBoxThatCutsNothing) {
  const auto cube = [](double size) {
    return WrittenSolids{.solids = {test::placed("cube", Box{{size, size, size}}, {0, 0, 0})},
                         .tree = CsgTree::leaf(0)};
  };
  EXPECT_EQ(cut(cube(2 + 3.4 * k_tolerance), surface_of(cube(2))).solids.size(), 1U);
}

/// A bar with a needle on it.
WrittenSolids needle_on_a_bar(double length) {
  const Cone needle{.radius_bottom = 0.2, .radius_top = 0, .height = 4};
  return {.solids = {test::placed("bar", Box{{length, 1, 1}}, {0, 0, 0}), test::placed("needle", needle, {0, 0, 2.3})},
          .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
}

/// Few points are near the tip, so that it is well beyond all of them.
TEST(WithoutWhatSticksOut, LeavesATipThatThePointsMissByChance) {
  Points points = surface_of(needle_on_a_bar(4));
  points.resize(900);
  const double highest = bounds_of(points).max().z();
  const WrittenSolids same = needle_on_a_bar(4);
  const BareSurface far = find_bare_surface(same.tree, same.solids, points, 2 * k_tolerance);
  double above = highest;
  for (std::size_t i = 0; i < far.samples.size(); ++i) above = std::max(above, far.samples.positions[i].z());
  ASSERT_GT(above, highest + 2 * k_tolerance);
  EXPECT_EQ(cut(same, points).solids.size(), 2U);
  const AlignedBox reached = bounds_of(surface_of(cut(needle_on_a_bar(5), points)));
  EXPECT_LT(reached.max().x(), 2.1) << "cut off";
  EXPECT_GT(reached.max().z(), highest + 2 * k_tolerance) << "not cut off";
}

}  // namespace
}  // namespace cloud2csg
