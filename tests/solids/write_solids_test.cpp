#include "raw/solids/write_solids.hpp"

#include <gtest/gtest.h>

#include "cloud2csg/sample.hpp"
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

TEST(WithoutWhatSticksOut, EndsTheSolidWhereThePointsEnd) {
  const Points points = surface_of(bar_of(4));
  const WrittenSolids cut = without_what_sticks_out(bar_of(5), points, k_tolerance);
  ASSERT_EQ(cut.solids.size(), 3U);
  EXPECT_EQ(cut.solids[2].id, "box_0");
  const AlignedBox reached = bounds_of(surface_of(cut));
  EXPECT_NEAR(reached.max().x(), bounds_of(points).max().x() + k_tolerance, 1e-6);
  EXPECT_NEAR(reached.min().x(), -3, 0.01) << "the ball stays as it is";
  EXPECT_NEAR(reached.max().z(), 1, 0.01);
}

TEST(WithoutWhatSticksOut, LeavesASolidWithinTheBoundsAlone) {
  const Points points = surface_of(bar_of(4));
  const WrittenSolids same = without_what_sticks_out(bar_of(4 + 2 * k_tolerance), points, k_tolerance);
  EXPECT_EQ(same.solids.size(), 2U);
  EXPECT_EQ(same.tree, bar_of(4).tree);
}

/// Few points are near the tip of a needle, so that it is well beyond all of them.
TEST(WithoutWhatSticksOut, LeavesATipThatThePointsMissByChance) {
  const WrittenSolids needle{
      .solids = {test::placed("needle", Cone{.radius_bottom = 0.2, .radius_top = 0, .height = 4}, {0, 0, 0})},
      .tree = CsgTree::leaf(0)};
  Points points = surface_of(needle);
  points.resize(400);
  ASSERT_LT(bounds_of(points).max().z(), 2 - 2 * k_tolerance);
  EXPECT_EQ(without_what_sticks_out(needle, points, k_tolerance).solids.size(), 1U);
}

}  // namespace
}  // namespace cloud2csg
