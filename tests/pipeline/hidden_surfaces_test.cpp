// Walls that no sensor saw.
#include <gtest/gtest.h>

#include <numbers>

#include "cloud2csg/reconstruct.hpp"
#include "cloud2csg/sample.hpp"
#include "pipeline/reconstructed.hpp"
#include "support/known_solids.hpp"
#include "support/warnings.hpp"

namespace cloud2csg {
namespace {

/// Of bores as long as this the middle is seen by no sensor.
TEST(ReconstructHidden, TakesTheWallsOfADeepBoreToGoOn) {
  const Model truth{.primitives = {test::placed("bar", Box{{2, 2, 12}}, {0, 0, 0}),
                                   test::placed("bore", Cylinder{.radius = 0.6, .height = 14}, {0, 0, 0})},
                    .tree = subtract(CsgTree::leaf(0), CsgTree::leaf(1))};
  const PointCloud scan = scan_model(truth, {.count = 60'000});
  const Extraction result = reconstruct(scan);
  EXPECT_LE(leaf_count(result.tree()), 2U);
  EXPECT_GT(test::iou(result, truth), 0.97);
  EXPECT_TRUE(test::mentions(result.statistics.warnings, "no sensor saw far into 1 of the holes"));
  EXPECT_GT(result.statistics.finding->added_points, 500U);
  EXPECT_LT(test::iou(reconstruct(scan, {.close_unseen = false}), truth), 0.95);
}

/// The inside of its bend is hardly seen.
TEST(ReconstructHidden, TakesABentPipeToBeHollowAllAlong) {
  Model truth{.primitives = {test::placed("bend", Torus{.major_radius = 3, .minor_radius = 1}, {0, 0, 0}),
                             test::placed("inside", Torus{.major_radius = 3, .minor_radius = 0.7}, {0, 0, 0}),
                             test::placed("quarter", Box{{8, 8, 4}}, {4, 4, 0}),
                             test::placed("leg", Cylinder{.radius = 1, .height = 3}, {3, -1.5, 0}),
                             test::placed("bore", Cylinder{.radius = 0.7, .height = 4}, {3, -2, 0}),
                             test::placed("arm", Cylinder{.radius = 1, .height = 3}, {-1.5, 3, 0}),
                             test::placed("duct", Cylinder{.radius = 0.7, .height = 4}, {-2, 3, 0})},
              .tree = {}};
  for (const std::size_t k : {3U, 4U}) {
    truth.primitives[k].pose.orientation = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX());
  }
  for (const std::size_t k : {5U, 6U}) {
    truth.primitives[k].pose.orientation = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY());
  }
  truth.tree = parse_tree("(bend & quarter | leg | arm) - (inside & quarter | bore | duct)", truth.primitives);
  const PointCloud scan = scan_model(truth, {.count = 60'000});
  const Extraction result = reconstruct(scan);
  EXPECT_GT(test::iou(result, truth), 0.97);
  EXPECT_TRUE(test::mentions(result.statistics.warnings, "no sensor saw far into 1 of the bends"));
  EXPECT_LT(test::iou(reconstruct(scan, {.close_unseen = false}), truth), 0.9);
}

/// On a table, with a shelf. Sensors saw below it, but not its underside.
TEST(ReconstructHidden, ClosesTheUndersideOfAnOverhang) {
  const Model truth{.primitives = {test::placed("base", Box{{4, 4, 1}}, {-2, 0, 0}),
                                   test::placed("post", Box{{1, 4, 5}}, {-0.5, 0, 2}),
                                   test::placed("shelf", Box{{4, 4, 0.7}}, {2, 0, 4.15})},
                    .tree = unite(unite(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2))};
  const Extraction result = reconstruct(scan_model(truth, {.on_table = true, .count = 60'000}));
  EXPECT_GT(test::iou(result, truth), 0.97);
  EXPECT_TRUE(test::mentions(result.statistics.warnings, "the underside of 1 overhang, the largest near"));
}

/// Sensors from above see no line below the plate. But its walls end where they would have seen them go on.
TEST(ReconstructHidden, DoesNotFillTheSpaceBesideAFoot) {
  const Model truth{.primitives = {test::placed("plate", Box{{1.4, 0.9, 0.14}}, {0, 0, 0.07}),
                                   test::placed("foot", Box{{0.24, 0.6, 0.13}}, {-0.5, 0, -0.035})},
                    .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Extraction result = reconstruct(scan_model(truth, {.on_table = true, .count = 40'000, .seed = seed}));
    EXPECT_GT(test::iou(result, truth), 0.97) << seed;
  }
}

/// Below the cone of its recess, walls of the neck end high above the table.
TEST(ReconstructHidden, ClosesNothingInTheAirAboveARecess) {
  const Profile profile{{{{{20, 0}},
                          {{10, 30}},
                          {{10, 42}},
                          {{6, 42}},
                          {{6, 30}},
                          {{15, 1}},
                          {{15, -10}},
                          {{28, -10}},
                          {{28, -6}},
                          {{20, -6}}}}};
  const Model truth{.primitives = {{.id = "nozzle", .shape = Revolution{profile}, .pose = {}}},
                    .tree = CsgTree::leaf(0)};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Extraction result = reconstruct(scan_model(truth, {.on_table = true, .count = 20'000, .seed = seed}));
    EXPECT_NE(result.statistics.verdict.grade, Grade::failed) << seed;
    for (const ClosedSurface& closed : result.statistics.finding->closed) {
      EXPECT_NE(closed.reason, Unseen::underside) << seed;
    }
  }
}

/// A pipe that stands on a table. Sensors above it see neither its foot nor the depth of its bore.
TEST(ReconstructHidden, TakesABoreToGoThrough) {
  const Model truth{.primitives = {test::placed("pipe", Cylinder{.radius = 1.3, .height = 9}, {0, 0, 0}),
                                   test::placed("bore", Cylinder{.radius = 1, .height = 10}, {0, 0, 0})},
                    .tree = subtract(CsgTree::leaf(0), CsgTree::leaf(1))};
  const PointCloud scan = scan_model(truth, {.on_table = true, .count = 60'000});
  const Extraction result = reconstruct(scan);
  EXPECT_GT(test::iou(result, truth), 0.95);
  EXPECT_TRUE(test::mentions(result.statistics.warnings, "no sensor saw far into"));
  EXPECT_LT(test::iou(reconstruct(scan, {.close_unseen = false}), truth), 0.9);
}

/// Coaxial holes with air between them, which sensors saw through.
TEST(ReconstructHidden, TakesHolesOfTwoEarsForNoBore) {
  Model truth{
      .primitives = {test::placed("base", Box{{4, 6, 1}}, {0, 0, 0}), test::placed("ear", Box{{4, 1, 4}}, {0, -2.5, 2}),
                     test::placed("other", Box{{4, 1, 4}}, {0, 2.5, 2}),
                     test::placed("pin", Cylinder{.radius = 0.8, .height = 9}, {0, 0, 2.4})},
      .tree = {}};
  truth.primitives[3].pose.orientation = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX());
  truth.tree = parse_tree("(base | ear | other) - pin", truth.primitives);
  const Extraction result = reconstruct(scan_model(truth, {.count = 60'000}));
  EXPECT_GT(test::iou(result, truth), 0.98);
  EXPECT_FALSE(test::mentions(result.statistics.warnings, "no sensor saw"));
  EXPECT_EQ(result.statistics.finding->added_points, 0U);
}

}  // namespace
}  // namespace cloud2csg
