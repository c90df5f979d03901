#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"
#include "solids/recovered_part.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

using test::expect_recovered;
using test::iou_with;
using test::Part;
using test::part_of;
using test::quick;
using test::turned;

Part plate_with_holes() {
  return part_of(
      {test::placed("plate", Box{{4, 3, 0.5}}, {0, 0, 0}), test::placed("a", Cylinder{0.4, 2}, {-1.2, 0.5, 0}),
       test::placed("b", Cylinder{0.4, 2}, {1.2, 0.5, 0}), test::placed("c", Cylinder{0.6, 2}, {0, -0.6, 0})},
      "plate - a - b - c");
}

TEST(ChooseSolids, FindsAPlateWithHoles) {
  expect_recovered(plate_with_holes(), 1);
}

/// The points of each side are as near to the other as to their own, but the sides are known much better.
TEST(ChooseSolids, FindsASheetOfTwoAndAHalfDeviations) {
  constexpr double k_noise = 0.02;
  const Part sheet = part_of({test::placed("sheet", Box{{4, 3, 2.5 * k_noise}}, {0, 0, 0})}, "sheet", k_noise);
  const SolidChoice choice = choose_solids(sheet.cloud, sheet.surfaces, quick());
  ASSERT_EQ(choice.solids.size(), 1U);
  const Eigen::Vector3d size = bounds(choice.solids[0]).sizes();
  EXPECT_NEAR(size.z(), 2.5 * k_noise, 0.2 * k_noise);
}

/// A groove around a corner, which is broken off: no surface shows where the plate ends within the groove.
TEST(ChooseSolids, LeavesOutWhatLiesBehindAGroove) {
  const Part plate =
      part_of({turned(test::placed("plate", Box{{10, 10, 2.5}}, {5.16, 5.16, 1.88}), {-1, 1, 0}, 45),
               test::placed("groove", Torus{.major_radius = 10, .minor_radius = 2}, {0, 0, 0}),
               turned(test::placed("corner", Box{{12, 40, 40}}, {10.96, 10.96, -1.89}), {0, 0.59, 0.57}, 55.25)},
              "plate - groove - corner");
  ASSERT_EQ(plate.surfaces.size(), 7U) << "no point is on the surface of the corner";
  const std::vector<ChoiceRound> rounds = expect_recovered(plate, 3).rounds;
  ASSERT_GE(rounds.size(), 2U);
  EXPECT_GT(rounds[1].planes, 0U);
  EXPECT_LT(rounds[1].disagreement, 0.5 * rounds[0].disagreement);
}

/// Bores from the top, the bottom and a side, so that no extrusion has several of them.
Part block_with_bores() {
  return part_of(
      {test::placed("block", Box{{4, 3, 2}}, {0, 0, 0}), test::placed("a", Cylinder{0.4, 2}, {-1.2, 0.5, 1.2}),
       test::placed("b", Cylinder{0.4, 2}, {0.2, 0.5, -1.0}),
       turned(test::placed("c", Cylinder{0.6, 2}, {2, -0.6, 0}), {0, 1, 0}, 90)},
      "block - a - b - c");
}

TEST(ChooseSolids, FindsABlockWithBores) {
  expect_recovered(block_with_bores(), 4);
}

/// Its mouths are ellipses, so it is in no drawing of the plate.
TEST(ChooseSolids, FindsAnObliqueBore) {
  for (const double degrees : {20.0, 50.0}) {
    expect_recovered(part_of({test::placed("plate", Box{{4, 3, 0.8}}, {0, 0, 0}),
                              turned(test::placed("bore", Cylinder{0.4, 6}, {0.3, 0.1, 0}), {1, 2, 0}, degrees)},
                             "plate - bore"),
                     2);
  }
}

/// So many holes along each side.
Part plate_with_rows_of_holes(int count) {
  const double length = count;
  PrimitiveSet solids{test::placed("plate", Box{{length, length, 0.6}}, {0.5 * length, 0.5 * length, 0})};
  std::string formula = "plate";
  for (int x = 0; x < count; ++x) {
    for (int y = 0; y < count; ++y) {
      solids.push_back(
          test::placed(fmt::format("hole_{}_{}", x, y).c_str(), Cylinder{0.3, 1.2}, {x + 0.5, y + 0.5, 0}));
      formula += " - " + solids.back().id;
    }
  }
  Part part{.solids = std::move(solids), .tree = {}, .cloud = {}, .surfaces = {}};
  part.tree = parse_tree(formula, part.solids);
  const auto points = static_cast<std::size_t>(300 * count * count);
  part.cloud =
      sample_surface({.primitives = part.solids, .tree = part.tree}, {.count = points, .noise = 0.002, .seed = 3});
  part.surfaces = test::known_surfaces(part.solids, part.cloud, 0.008, 30);
  return part;
}

TEST(ChooseSolids, FindsHundredsOfHoles) {
  const Part part = plate_with_rows_of_holes(16);
  const SolidChoice choice = choose_solids(part.cloud, part.surfaces);
  EXPECT_LE(leaf_count(choice.tree), 2U);
  std::size_t paths = 0;
  for (const Primitive& solid : choice.solids) {
    if (const auto* extrusion = std::get_if<Extrusion>(&solid.shape)) paths += extrusion->profile.paths.size();
  }
  EXPECT_GE(paths, 256U);
  EXPECT_LT(choice.disagreement, 0.03);
  EXPECT_TRUE(choice.warnings.empty());
}

TEST(ChooseSolids, WarnsWhereItsGuardEndsTheChoice) {
  const Part part = block_with_bores();
  SolidOptions options = quick();
  options.most_rules = 2;
  const SolidChoice choice = choose_solids(part.cloud, part.surfaces, options);
  ASSERT_EQ(choice.warnings.size(), 1U);
  EXPECT_NE(choice.warnings.front().find("more than 2 parts"), std::string::npos) << choice.warnings.front();
}

TEST(ChooseSolids, FindsABracketOfTwoBoxes) {
  expect_recovered(part_of({test::placed("foot", Box{{3, 2, 0.4}}, {0, 0, 0.2}),
                            test::placed("back", Box{{0.4, 2, 2}}, {-1.3, 0, 1})},
                           "foot | back"),
                   2);
}

TEST(ChooseSolids, FindsHalfASphereOnACylinder) {
  expect_recovered(
      part_of({test::placed("post", Cylinder{0.6, 2}, {0, 0, 1}), test::placed("ball", Sphere{1}, {0, 0, 2}),
               test::placed("upper", Box{{4, 4, 2}}, {0, 0, 3})},
              "post | (ball & upper)"),
      3);
}

TEST(ChooseSolids, FindsNestedPockets) {
  expect_recovered(
      part_of(
          {test::placed("block", Box{{4, 4, 2}}, {0, 0, 0}), test::placed("wide", Box{{3, 3, 1}}, {0, 0, 1}),
           test::placed("deep", Box{{1.5, 1.5, 1}}, {0, 0, 0.3}), test::placed("pin", Cylinder{0.4, 1.2}, {0, 0, 0.2})},
          "block - wide - deep | pin"),
      4);
}

TEST(ChooseSolids, FindsAHexagonalPrism) {
  Polytope prism{.planes = {{{0, 0, 1}, 0.5}, {{0, 0, -1}, 0.5}}};
  for (int side = 0; side < 6; ++side) {
    const double angle = side * std::numbers::pi / 3;
    prism.planes.push_back({{std::cos(angle), std::sin(angle), 0}, 1.0});
  }
  expect_recovered(part_of({test::placed("prism", prism, {0, 0, 0}), test::placed("hole", Cylinder{0.5, 3}, {0, 0, 0})},
                           "prism - hole"),
                   2);
}

TEST(ChooseSolids, FindsATurnedPart) {
  const Eigen::Vector3d axis(1, 2, 0.5);
  expect_recovered(part_of({turned(test::placed("block", Box{{3, 2, 1}}, {0, 0, 0}), axis, 33),
                            turned(test::placed("hole", Cylinder{0.5, 3}, {0, 0, 0}), axis, 33)},
                           "block - hole"),
                   2);
}

TEST(ChooseSolids, FindsAConeAndATorus) {
  expect_recovered(part_of({test::placed("cone", Cone{1.0, 0.4, 1.5}, {0, 0, 0}),
                            test::placed("ring", Torus{1.5, 0.3}, {0, 0, -0.9})},
                           "cone | ring"),
                   2);
}

TEST(ChooseSolids, DoesNotDependOnScaleOrPlace) {
  const Part part = plate_with_holes();
  Part large = part;
  const Eigen::Vector3d shift(1000, -2000, 500);
  for (std::size_t i = 0; i < large.cloud.size(); ++i)
    large.cloud.positions.set(i, 100 * part.cloud.positions[i] + shift);
  for (DetectedSurface& detected : large.surfaces) {
    detected.surface.position = 100 * detected.surface.position + shift;
    detected.surface.radius *= 100;
    detected.rms *= 100;
  }
  const SolidChoice small_choice = choose_solids(part.cloud, part.surfaces, quick());
  const SolidChoice large_choice = choose_solids(large.cloud, large.surfaces, quick());
  EXPECT_EQ(to_text(small_choice.tree, small_choice.solids), to_text(large_choice.tree, large_choice.solids));
  EXPECT_NEAR(small_choice.disagreement, large_choice.disagreement, 1e-3);
}

TEST(ChooseSolids, DoesNotDependOnThreads) {
  const Part part = plate_with_holes();
  const SolidChoice one = choose_solids(part.cloud, part.surfaces, quick(), {.threads = 1});
  const SolidChoice two = choose_solids(part.cloud, part.surfaces, quick(), {.threads = 2});
  EXPECT_EQ(one.tree, two.tree);
  EXPECT_EQ(one.disagreement, two.disagreement);
  EXPECT_EQ(one.places.weights, two.places.weights);
}

TEST(ChooseSolids, RefusesWhatItCannotUse) {
  const Part part = plate_with_holes();
  EXPECT_THROW((void)choose_solids(part.cloud, {}, quick()), Error);
  EXPECT_THROW((void)choose_solids({.positions = part.cloud.positions, .normals = {}}, part.surfaces, quick()), Error);
  SolidOptions options = quick();
  options.leaf_cost = 0;
  try {
    (void)choose_solids(part.cloud, part.surfaces, options);
    FAIL() << "expected an error";
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().where, "leaf_cost");
  }
}

TEST(ChooseSolids, IsCancelledBeforeTheSearch) {
  const Part part = plate_with_holes();
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)choose_solids(part.cloud, part.surfaces, quick(), {.stop = stop.get_token()}), Cancelled);
}

/// What lies on the known solids is theirs, and no surface.
SolidChoice choose_beside(const Part& part, const PrimitiveSet& known) {
  const std::vector<SurfacePoints> own = deal_points(part.cloud, known, {.distance = 0.01, .cosine = 0.8});
  std::vector<KnownSolid> solids;
  std::vector<std::uint8_t> is_taken(part.cloud.size(), 0);
  for (std::size_t k = 0; k < known.size(); ++k) {
    solids.push_back({.solid = known[k], .own = own[k]});
    for (const std::uint32_t i : own[k].points) is_taken[i] = 1;
  }
  std::vector<DetectedSurface> rest = part.surfaces;
  for (DetectedSurface& surface : rest) {
    std::erase_if(surface.points, [&](std::uint32_t i) { return is_taken[i] != 0; });
  }
  std::erase_if(rest, [](const DetectedSurface& surface) { return surface.points.size() < 12; });
  return choose_solids(part.cloud, rest, solids, quick(), {});
}

TEST(ChooseSolids, KeepsWhatIsKnownAndFindsTheRest) {
  const Part part = plate_with_holes();
  const PrimitiveSet known{part.solids[0], part.solids[3]};
  const SolidChoice choice = choose_beside(part, known);
  ASSERT_EQ(choice.solids.size(), 3U) << to_text(choice.tree, choice.solids) << ": both other holes are one extrusion";
  EXPECT_EQ(choice.solids[0].id, "plate");
  EXPECT_EQ(choice.solids[1].id, "c");
  EXPECT_EQ(choice.solids[1].pose.position, known[1].pose.position);
  EXPECT_EQ(std::get<Cylinder>(choice.solids[1].shape).height, 2);
  EXPECT_EQ(leaf_count(choice.tree), 3U);
  EXPECT_EQ(primitives_of(choice.tree).size(), 3U);
  EXPECT_GE(iou_with(part, choice), 0.99);
}

TEST(ChooseSolids, NeedsNoSurfaceWhereAllIsKnown) {
  const Part part = plate_with_holes();
  const SolidChoice choice = choose_beside(part, part.solids);
  EXPECT_EQ(choice.solids.size(), 4U);
  EXPECT_EQ(leaf_count(choice.tree), 4U);
  EXPECT_LT(choice.disagreement, 0.03);
}

TEST(ChooseSolids, GivesNewSolidsIdsOfTheirOwn) {
  const Part part = block_with_bores();
  Primitive known = part.solids[1];
  known.id = "cylinder_0";
  const SolidChoice choice = choose_beside(part, {known});
  std::set<std::string> ids;
  for (const Primitive& solid : choice.solids) EXPECT_TRUE(ids.insert(solid.id).second) << solid.id;
  EXPECT_EQ(leaf_count(choice.tree), 4U);
}

TEST(ChooseSolids, DoesWithoutWhatIsNotThere) {
  const Part part = plate_with_holes();
  const PrimitiveSet known{test::placed("ghost", Sphere{0.3}, {5, 5, 5}),
                           test::placed("wrong", Box{{2, 2, 2}}, {1, 1, 1})};
  const SolidChoice choice = choose_beside(part, known);
  const std::vector<PrimitiveIndex> used = primitives_of(choice.tree);
  EXPECT_EQ(std::ranges::count_if(used, [](PrimitiveIndex p) { return p < 2; }), 0);
  EXPECT_GE(iou_with(part, choice), 0.98);
}

TEST(ChooseSolids, TakesKnownFreeForms) {
  Primitive wavy = test::placed("wavy", Box{{2, 2, 1}}, {0, 0, 0});
  wavy.displacement = Displacement{.frequency = 2.5};
  const Part part = part_of({wavy, test::placed("hole", Cylinder{0.4, 4}, {0, 0, 0})}, "wavy - hole");
  const SolidChoice choice = choose_beside(part, {part.solids[0]});
  EXPECT_EQ(leaf_count(choice.tree), 2U) << to_text(choice.tree, choice.solids);
  EXPECT_GE(iou_with(part, choice), 0.99);
}

TEST(ChooseSolids, RefusesGivenValuesThatAreNone) {
  const Part part = plate_with_holes();
  SolidOptions options = quick();
  options.regularity.radii = {1, -1};
  EXPECT_THROW((void)choose_solids(part.cloud, part.surfaces, options), Error);
  options = quick();
  options.regularity.axes = {Eigen::Vector3d::Zero()};
  EXPECT_THROW((void)choose_solids(part.cloud, part.surfaces, options), Error);
}

TEST(ChooseSolids, TakesGivenRadiiWithoutSnapping) {
  const Part part = block_with_bores();
  SolidOptions options = quick();
  options.regularity = {.snap = false, .radii = {0.405, 0.602}, .given_tolerance = 0.02};
  const SolidChoice choice = choose_solids(part.cloud, part.surfaces, options);
  std::set<double> radii;
  for (const Primitive& solid : choice.solids) {
    if (const auto* hole = std::get_if<Cylinder>(&solid.shape)) radii.insert(hole->radius);
  }
  EXPECT_EQ(radii, (std::set<double>{0.405, 0.602}));
  for (const Snap& snap : choice.snaps) EXPECT_EQ(snap.kind, RegularityKind::given_radius);
}

}  // namespace
}  // namespace cloud2csg
