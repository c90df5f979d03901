#include <gtest/gtest.h>

#include <variant>

#include "cloud2csg/advanced/solids.hpp"
#include "core/primitive/profile.hpp"
#include "solids/recovered_part.hpp"
#include "support/any_profile.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

using test::expect_recovered;
using test::Part;
using test::part_of;
using test::quick;
using test::turned;

TEST(TurnedParts, FindsArcsThatEndOnTheAxis) {
  for (const double centre : {0.5, -0.5}) {
    const Primitive round = test::placed("round", test::turned_arc(centre, 1.5), {0, 0, 0});
    expect_recovered(part_of({round}, "round"), 1);
    const Primitive block = test::placed("block", Box{{6, 5, 4}}, {0, 0, 2});
    expect_recovered(part_of({block, round}, "block - round"), 2);
  }
}

TEST(TurnedParts, FindsATorusThatTouchesItsAxis) {
  Part part = part_of({test::placed("horn", Torus{1, 1}, {0, 0, 0})}, "horn", 0);
  part.surfaces[0].surface.radius *= 1 - 1e-9;
  const SolidChoice choice = choose_solids(part.cloud, part.surfaces, quick());
  ASSERT_EQ(choice.solids.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<Torus>(choice.solids[0].shape));
  EXPECT_NO_THROW(validate(choice.solids[0]));
}

/// Nothing is seen of where the bend goes over into the straight pipes.
TEST(TurnedParts, FindsABentPipe) {
  const Part pipe =
      part_of({test::placed("bend", Torus{3, 1}, {0, 0, 0}), test::placed("quarter", Box{{6, 6, 4}}, {3, 3, 0}),
               turned(test::placed("down", Cylinder{1, 2.5}, {3, -1.25, 0}), {1, 0, 0}, 90),
               turned(test::placed("left", Cylinder{1, 2.5}, {-1.25, 3, 0}), {0, 1, 0}, 90)},
              "(bend & quarter) | down | left");
  expect_recovered(pipe, 3);
}

/// Two bends that go over into each other, where nothing is seen of it either.
TEST(TurnedParts, FindsAPipeWithTwoBends) {
  const Part pipe = part_of(
      {test::placed("one", Torus{3, 1}, {0, 0, 0}), test::placed("bore_of_one", Torus{3, 0.6}, {0, 0, 0}),
       test::placed("quarter", Box{{6, 6, 4}}, {3, 3, 0}), test::placed("two", Torus{3, 1}, {0, 6, 0}),
       test::placed("bore_of_two", Torus{3, 0.6}, {0, 6, 0}), test::placed("opposite", Box{{6, 6, 4}}, {-3, 3, 0})},
      "(one - bore_of_one) & quarter | (two - bore_of_two) & opposite");
  expect_recovered(pipe, 2);
}

/// No point is at the tip, but the cone ends nowhere else.
TEST(TurnedParts, FindsATip) {
  const Part pencil =
      part_of({test::placed("shaft", Cylinder{1, 3}, {0, 0, 0}),
               test::placed("tip", Cone{.radius_bottom = 1, .radius_top = 0, .height = 2}, {0, 0, 2.5})},
              "shaft | tip");
  const SolidChoice choice = expect_recovered(pencil, 1);
  const auto* const turned = std::get_if<Revolution>(&choice.solids[0].shape);
  ASSERT_NE(turned, nullptr);
  EXPECT_EQ(count_segments(turned->profile), 4U) << "the axis is one";
  EXPECT_NEAR(bounds(choice.solids[0]).max().z(), 3.5, 0.01);
}

/// A chamfered end has a face, which ends the solid.
TEST(TurnedParts, MakesNoTipOfAChamfer) {
  const Part pin =
      part_of({test::placed("shaft", Cylinder{1, 3}, {0, 0, 0}),
               test::placed("chamfer", Cone{.radius_bottom = 1, .radius_top = 0.8, .height = 0.2}, {0, 0, 1.6})},
              "shaft | chamfer");
  EXPECT_NEAR(bounds(expect_recovered(pin, 1).solids[0]).max().z(), 1.7, 0.01);
}

TEST(TurnedParts, FindsThreeQuartersOfATurnedShell) {
  const Part shell =
      part_of({test::placed("cone", Cone{2, 1.2, 1.5}, {0, 0, 0}), test::placed("groove", Torus{1.6, 0.3}, {0, 0, 0}),
               test::placed("bore", Cylinder{0.7, 3}, {0, 0, 0}), test::placed("gap", Box{{4, 4, 4}}, {2, 2, 0})},
              "cone - groove - bore - gap");
  expect_recovered(shell, 1);
}

}  // namespace
}  // namespace cloud2csg
