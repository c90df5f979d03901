#include "cloud2csg/reconstruct.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>
#include <thread>

#include "cloud2csg/compare.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"
#include "paper/objective/objective.hpp"
#include "pipeline/reconstructed.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"
#include "support/warnings.hpp"

namespace cloud2csg {
namespace {

/// A plate with two holes and a boss on it.
Model plate() {
  PrimitiveSet primitives{test::placed("plate", Box{{4, 3, 0.6}}, {0, 0, 0}),
                          test::placed("boss", Cylinder{.radius = 0.6, .height = 1}, {0.2, 0.2, 0.6}),
                          test::placed("left", Cylinder{.radius = 0.4, .height = 2}, {-1.3, 0.3, 0}),
                          test::placed("right", Cylinder{.radius = 0.35, .height = 2}, {1.4, -0.6, 0})};
  const CsgTree body = unite_all(std::vector{CsgTree::leaf(0), CsgTree::leaf(1)});
  return {.primitives = std::move(primitives), .tree = subtract(subtract(body, CsgTree::leaf(2)), CsgTree::leaf(3))};
}

PointCloud raw_cloud(const Model& model, double noise, std::size_t count = 20'000) {
  return sample_surface(model, {.count = count, .noise = noise, .seed = 5});
}

TEST(Reconstruct, FindsThePlateWithItsHolesAndBoss) {
  const Model truth = plate();
  for (const double noise : {0.0, 0.008}) {
    const Extraction result = reconstruct(raw_cloud(truth, noise));
    EXPECT_GT(test::iou(result, truth), 0.99);
    EXPECT_EQ(leaf_count(result.tree()), 2U) << "a plate with holes and a boss";
    ASSERT_TRUE(result.statistics.finding);
    EXPECT_EQ(std::ranges::count(result.statistics.finding->surfaces, SurfaceType::plane), 7);
    EXPECT_EQ(std::ranges::count(result.statistics.finding->surfaces, SurfaceType::cylinder), 3);
    EXPECT_LT(result.statistics.finding->disagreement, 0.03);
    ASSERT_FALSE(result.statistics.finding->rounds.empty());
    EXPECT_EQ(result.statistics.finding->rounds.back().leaves, 2U);
  }
}

TEST(Reconstruct, ItsStatisticsListWhatWasMadeRegular) {
  const ExtractStatistics statistics = reconstruct(raw_cloud(plate(), 0.008)).statistics;
  const auto json = nlohmann::json::parse(to_json(statistics))["finding"];
  ASSERT_FALSE(json["snaps"].empty());
  double turn = 0;
  double shift = 0;
  for (const auto& snap : json["snaps"]) {
    ASSERT_LT(snap["surface"].get<std::size_t>(), json["surfaces"].get<std::size_t>());
    EXPECT_EQ(snap["type"], type_name(statistics.finding->surfaces[snap["surface"].get<std::size_t>()]));
    double& largest = snap["kind"] == "direction" ? turn : shift;
    largest = std::max(largest, snap["change"].get<double>());
  }
  EXPECT_GT(turn, 0);
  EXPECT_EQ(turn, json["largest_turn_deg"].get<double>());
  EXPECT_EQ(shift, json["largest_shift"].get<double>());
}

/// A hole in the cloud that is as large as a face: the user is told of it.
TEST(Reconstruct, SaysWhereItsSurfaceHasNoPoints) {
  const Model truth{.primitives = {test::placed("block", Box{{4, 3, 3}}, {0, 0, 0})}, .tree = CsgTree::leaf(0)};
  const PointCloud whole = raw_cloud(truth, 0.0);
  EXPECT_FALSE(test::mentions(reconstruct(whole).statistics.verdict.doubts, "no points near"));
  PointCloud open;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (whole.positions.z[i] > 1.499) continue;  // the top
    open.positions.push_back(whole.positions[i]);
    open.normals.push_back(whole.normals[i]);
  }
  const Extraction result = reconstruct(open, {.close_unseen = false});
  EXPECT_GT(test::iou(result, truth), 0.9);
  EXPECT_TRUE(test::mentions(result.statistics.verdict.doubts, "no points near"));
  EXPECT_FALSE(test::mentions(result.statistics.warnings, "closed by a plane"));
  const Extraction closed = reconstruct(open);
  EXPECT_GT(test::iou(closed, truth), 0.99);
  EXPECT_TRUE(test::mentions(closed.statistics.warnings, "closed by a plane"));
  EXPECT_FALSE(test::mentions(closed.statistics.verdict.doubts, "no points near"));
  EXPECT_TRUE(test::mentions(closed.statistics.verdict.doubts, "nobody saw"));
  // 12 of 66, without a border that is near points of the walls.
  EXPECT_GT(closed.statistics.verdict.closed_surface.value(), 0.1);
  EXPECT_LT(closed.statistics.verdict.closed_surface.value(), 12.0 / 66);
  EXPECT_EQ(closed.statistics.verdict.grade, Grade::doubtful);
  ASSERT_EQ(closed.statistics.finding->closed.size(), 1U);
  const ClosedSurface& top = closed.statistics.finding->closed[0];
  EXPECT_EQ(top.reason, Unseen::side);
  EXPECT_LT((top.place - Eigen::Vector3d(0, 0, 1.5)).norm(), 0.05);
  EXPECT_LT(top.seen, 0.05);
}

/// Its ground is not seen, nor are parts of its holes.
TEST(Reconstruct, ClosesTheGroundOfAPlateOnATable) {
  const Model truth = plate();
  const PointCloud scan = scan_model(truth, {.on_table = true, .count = 60'000});
  const Extraction result = reconstruct(scan);
  EXPECT_GT(test::iou(result, truth), 0.97);
  EXPECT_TRUE(test::mentions(result.statistics.warnings, "closed by a plane"));
  EXPECT_GT(result.statistics.finding->added_points, 5000U);
  EXPECT_EQ(result.statistics.verdict.points, result.cloud.size());
  EXPECT_LE(result.cloud.size(), scan.size()) << "added points are no part of the cloud";
  EXPECT_EQ(result.statistics.fit.unexplained_points,
            unexplained_points(result.model, result.cloud, result.statistics.fit.tolerances, {}).size());
}

TEST(Reconstruct, NamesWhatItLeavesOut) {
  const Model truth{.primitives = {test::placed("block", Box{{4, 4, 4}}, {0, 0, 0}),
                                   test::placed("ball", Sphere{.radius = 0.1}, {4, 0, 0})},
                    .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
  PointCloud cloud =
      sample_surface({.primitives = truth.primitives, .tree = CsgTree::leaf(0)}, {.count = 20'000, .seed = 5});
  const PointCloud ball =
      sample_surface({.primitives = truth.primitives, .tree = CsgTree::leaf(1)}, {.count = 400, .seed = 6});
  for (std::size_t i = 0; i < ball.size(); ++i) {
    cloud.positions.push_back(ball.positions[i]);
    cloud.normals.push_back(ball.normals[i]);
  }
  const Extraction result = reconstruct(cloud);
  EXPECT_EQ(leaf_count(result.tree()), 1U);
  EXPECT_EQ(result.statistics.verdict.grade, Grade::doubtful);
  EXPECT_TRUE(test::mentions(result.statistics.verdict.doubts,
                             "1 of the detected surfaces is not on it, the largest a sphere of"));
  EXPECT_TRUE(reconstruct(raw_cloud(plate(), 0.008)).statistics.verdict.doubts.empty());
}

TEST(Reconstruct, RefusesAToleranceAsLargeAsTheCloud) {
  const PointCloud cloud = raw_cloud(plate(), 0.008, 5000);
  try {
    (void)reconstruct(cloud, {.detection = {.distance_tolerance = 10.0}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("as large as the cloud"), std::string::npos) << error.what();
  }
}

TEST(Reconstruct, WarnsOfAToleranceBelowTheNoise) {
  const PointCloud cloud = raw_cloud(plate(), 0.008, 5000);
  const auto warnings = [&](std::optional<double> tolerance) {
    return find_primitives(cloud, {.detection = {.distance_tolerance = tolerance}}).statistics.warnings;
  };
  EXPECT_TRUE(test::mentions(warnings(0.004), "is less than the noise of the points"));
  EXPECT_FALSE(test::mentions(warnings(0.02), "noise of the points"));
  EXPECT_FALSE(test::mentions(warnings({}), "noise of the points"));
}

TEST(Reconstruct, TellsItsDoubtsWhereItFindsNoSolid) {
  PointCloud sheet;  // whose normals are all wrong
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      sheet.positions.push_back({0.1 * i, 0.1 * j, 0});
      sheet.normals.push_back({1, 0, 0});
    }
  }
  try {
    (void)reconstruct(sheet);
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(test::mentions(error.parts().warnings, "normals"));
  }
}

TEST(Reconstruct, NeedsNoNormals) {
  const Model truth = plate();
  PointCloud cloud = raw_cloud(truth, 0.005, 30'000);
  cloud.normals = {};
  const Extraction result = reconstruct(cloud);
  EXPECT_TRUE(result.statistics.finding->normals_estimated);
  EXPECT_GT(test::iou(result, truth), 0.97);
}

TEST(Reconstruct, DoesNotDependOnThreads) {
  const PointCloud cloud = raw_cloud(plate(), 0.01);
  const Extraction one = reconstruct(cloud, {}, {.threads = 1});
  const Extraction two = reconstruct(cloud, {}, {.threads = 2});
  EXPECT_TRUE(one.tree() == two.tree());
  ASSERT_EQ(one.model.primitives.size(), two.model.primitives.size());
  for (std::size_t k = 0; k < one.model.primitives.size(); ++k) {
    EXPECT_EQ(one.model.primitives[k].pose.position, two.model.primitives[k].pose.position);
  }
}

TEST(Reconstruct, DoesNotDependOnUnits) {
  const Model truth = plate();
  const PointCloud cloud = raw_cloud(truth, 0.008);
  for (const double scale : {0.01, 3000.0}) {
    PointCloud other = cloud;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      other.positions.set(i, scale * (cloud.positions[i] + Eigen::Vector3d(500, -200, 900)));
    }
    EXPECT_EQ(leaf_count(reconstruct(other).tree()), 2U) << scale;
  }
}

TEST(Reconstruct, RefusesAFogOrSaysThatItIsDoubtful) {
  RandomStream random(3);
  PointCloud fog;
  for (int i = 0; i < 3000; ++i) {
    fog.positions.push_back(test::random_within(1, random));
    fog.normals.push_back(test::random_direction(random));
  }
  try {
    EXPECT_FALSE(reconstruct(fog).statistics.warnings.empty());
  } catch (const Error& error) {
    EXPECT_FALSE(error.parts().expected.empty());
  }
}

/// By default the tree is that of the choice of solids, else that of the strategy.
TEST(Reconstruct, MeasuresTheFitOfTheTreeThatItGives) {
  for (const Strategy strategy : {Strategy::automatic, Strategy::cells, Strategy::partition}) {
    const Extraction result = reconstruct(raw_cloud(plate(), 0.005), {.extraction = {.strategy = strategy}});
    EXPECT_EQ(result.statistics.cells.has_value(), strategy == Strategy::cells);
    EXPECT_EQ(result.statistics.partitions.empty(), strategy != Strategy::partition);
    const double noise = result.statistics.noise;
    const FitStatistics fit = measure_fit(result.model, result.cloud, noise, {}, {});
    EXPECT_NEAR(result.statistics.fit.rms_distance, fit.rms_distance, 1e-9);
    EXPECT_NEAR(result.statistics.fit.objective / fit.objective, 1, 1e-9);
  }
}

TEST(Reconstruct, EndsWhenItsTimeIsOver) {
  EXPECT_THROW((void)reconstruct(raw_cloud(plate(), 0.01), {.extraction = {.time_limit_seconds = 0.0}}), Error);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)reconstruct(raw_cloud(plate(), 0.01), {}, {.stop = stop.get_token()}), Cancelled);
}

/// All stages that tell of their progress, in their order.
std::vector<std::string> stages_of(const PointCloud& cloud) {
  std::vector<std::string> stages;
  const auto note = [&stages](const Progress& progress) {
    if (std::ranges::find(stages, progress.stage) == stages.end()) stages.emplace_back(progress.stage);
  };
  (void)reconstruct(cloud, {}, {.on_progress = note});
  return stages;
}

TEST(Reconstruct, HoldsItsTimeLimitInEveryStage) {
  const PointCloud cloud = raw_cloud(plate(), 0.01, 5000);
  const std::vector<std::string> stages = stages_of(cloud);
  EXPECT_GE(stages.size(), 3U);
  const CsgTree expected = reconstruct(cloud).tree();
  constexpr double k_limit = 0.3;
  for (const std::string& slow : stages) {
    bool is_over = false;
    const auto dawdle = [&](const Progress& progress) {
      if (is_over || progress.stage != slow) return;
      is_over = true;
      std::this_thread::sleep_for(std::chrono::duration<double>(1.1 * k_limit));
    };
    try {
      const Extraction result =
          reconstruct(cloud, {.extraction = {.time_limit_seconds = k_limit}}, {.on_progress = dawdle});
      EXPECT_TRUE(!result.statistics.complete || result.tree() == expected) << slow;
    } catch (const Error& error) {
      EXPECT_EQ(error.parts().where, "extraction.time_limit_seconds") << slow;
    }
  }
}

TEST(FindPrimitives, HoldsTheTimeLimitOfTheExtraction) {
  EXPECT_THROW((void)find_primitives(raw_cloud(plate(), 0.01), {.extraction = {.time_limit_seconds = 0.0}}), Error);
}

TEST(FindPrimitives, WarnsOfAToleranceInWhichPartsAreLost) {
  const auto says_so = [](double tolerance) {
    const Extraction found =
        find_primitives(raw_cloud(plate(), 0.0, 5000), {.detection = {.distance_tolerance = tolerance}});
    return test::mentions(found.statistics.warnings, "parts are lost");
  };
  EXPECT_FALSE(says_so(0.02));
  EXPECT_TRUE(says_so(0.4));
}

TEST(FindPrimitives, HasATreeWhenItIsStoppedWhileSolidsAreChosen) {
  std::stop_source stop;
  const auto stop_at_solids = [&stop](const Progress& progress) {
    if (progress.stage == "solids" && progress.done > 0) stop.request_stop();
  };
  const Extraction found = find_primitives(raw_cloud(test::paper_model("m0"), 0.005), {},
                                           {.stop = stop.get_token(), .on_progress = stop_at_solids});
  EXPECT_TRUE(stop.stop_requested());
  EXPECT_FALSE(found.model.primitives.empty());
  EXPECT_FALSE(is_constant(found.tree()));
}

TEST(FindPrimitives, GivesSolidsWhoseTreeIsNearTheCloud) {
  const Extraction found = find_primitives(raw_cloud(plate(), 0.005));
  EXPECT_FALSE(found.model.primitives.empty());
  EXPECT_LT(found.statistics.finding->disagreement, 0.03);
  for (const Primitive& solid : found.model.primitives) EXPECT_NO_THROW(validate(solid));
}

/// M1's box has a sine on it, which is no surface that is looked for.
TEST(ReconstructBesideKnown, GetsAModelWithAFreeFormRight) {
  const Model truth = test::paper_model("m1");
  const PointCloud cloud = raw_cloud(truth, 0.005, 50'000);
  const Extraction result = reconstruct(cloud, {.known = {truth.primitives[0]}});
  EXPECT_GT(test::iou(result, truth), 0.998);
  EXPECT_EQ(leaf_count(result.tree()), 4U) << to_text(result.tree(), result.model.primitives);
  EXPECT_EQ(result.model.primitives[0].id, "Box_0");
  EXPECT_EQ(result.model.primitives[0].displacement->frequency, truth.primitives[0].displacement->frequency);
  EXPECT_EQ(result.statistics.finding->known, 1U);
  EXPECT_GT(result.statistics.finding->known_points, 10'000U);
  EXPECT_LT(test::iou(reconstruct(cloud), truth), 0.97) << "what is known makes the difference";
  // The end of the cylinder sticks out by less than twice the tolerance, which is not worth two leaves any more.
  const PointCloud noisy = raw_cloud(truth, 0.01, 50'000);
  EXPECT_GT(test::iou(reconstruct(noisy, {.known = {truth.primitives[0]}}), truth), 0.99);
}

TEST(ReconstructBesideKnown, KeepsWhatIsKnownToTheLastBit) {
  const Model truth = plate();
  const PointCloud cloud = raw_cloud(truth, 0.008);
  for (const PrimitiveSet& known : {PrimitiveSet{truth.primitives[0]}, PrimitiveSet{truth.primitives[2]},
                                    PrimitiveSet{truth.primitives[1], truth.primitives[3]}, truth.primitives}) {
    const Extraction result = reconstruct(cloud, {.known = known});
    EXPECT_GT(test::iou(result, truth), 0.99) << known[0].id;
    EXPECT_LE(leaf_count(result.tree()), 4U) << to_text(result.tree(), result.model.primitives);
    const std::vector<PrimitiveIndex> used = primitives_of(result.tree());
    for (PrimitiveIndex p = 0; p < known.size(); ++p) {
      EXPECT_EQ(result.model.primitives[p].id, known[p].id);
      EXPECT_EQ(result.model.primitives[p].pose.position, known[p].pose.position);
      EXPECT_NE(std::ranges::find(used, p), used.end()) << known[p].id;
      EXPECT_GT(result.model.primitives[p].evidence.value().points, 100U);
      EXPECT_NEAR(result.model.primitives[p].evidence.value().rms, 0.008, 0.003);
    }
  }
}

TEST(ReconstructBesideKnown, WarnsOfWhatThePointsDoNotBearOut) {
  const Model truth = plate();
  const PrimitiveSet known{truth.primitives[0], test::placed("ghost", Sphere{0.4}, {0, 1, 1.5})};
  const Extraction result = reconstruct(raw_cloud(truth, 0.005), {.known = known});
  EXPECT_TRUE(test::mentions(result.statistics.warnings, "'ghost'"));
  EXPECT_FALSE(test::mentions(result.statistics.warnings, "'plate'"));
  EXPECT_GT(test::iou(result, truth), 0.99);
  EXPECT_EQ(result.model.primitives[1].id, "ghost") << "it stays in the list";
  const Extraction found = find_primitives(raw_cloud(truth, 0.005), {.known = known});
  EXPECT_TRUE(test::mentions(found.statistics.warnings, "known primitive 'ghost': 0 of"));
}

TEST(ReconstructBesideKnown, RefusesKnownPrimitivesThatAreNone) {
  const Model truth = plate();
  const PointCloud cloud = raw_cloud(truth, 0.0, 2000);
  EXPECT_THROW((void)reconstruct(cloud, {.known = {truth.primitives[0], truth.primitives[0]}}), Error);
  EXPECT_THROW((void)reconstruct(cloud, {.known = {test::placed("s", Sphere{-1}, {0, 0, 0})}}), Error);
}

TEST(FindPrimitives, SaysHowManyPointsLieOnEachSolid) {
  const Extraction found = find_primitives(raw_cloud(plate(), 0.005));
  ASSERT_EQ(found.points.size(), found.model.primitives.size());
  std::size_t sum = 0;
  for (std::size_t k = 0; k < found.points.size(); ++k) {
    const Evidence evidence = found.model.primitives[k].evidence.value();
    EXPECT_EQ(evidence.points, found.points[k].points.size());
    EXPECT_EQ(evidence.rms, found.points[k].rms);
    EXPECT_NEAR(evidence.rms, 0.005, 0.002);
    sum += evidence.points;
  }
  EXPECT_GT(static_cast<double>(sum), 0.97 * static_cast<double>(found.cloud.size()));
}

TEST(FindPrimitives, TakesGivenRadiiAndAxes) {
  SolidOptions solids;
  solids.regularity.radii = {0.4, 0.35, 0.6};
  solids.regularity.axes = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  const Extraction found = find_primitives(raw_cloud(plate(), 0.008), {.solids = solids});
  std::vector<double> radii;
  for (const Primitive& solid : found.model.primitives) {
    if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape)) radii.push_back(cylinder->radius);
    if (const auto* extrusion = std::get_if<Extrusion>(&solid.shape)) {
      for (const ClosedPath& path : extrusion->profile.paths) {
        if (path.size() == 2) radii.push_back(0.5 * (path[0].point - path[1].point).norm());  // a circle
      }
    }
    const Eigen::Vector3d axis = solid.pose.orientation * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(axis.cwiseAbs().maxCoeff(), 1, 1e-12) << solid.id;
  }
  std::ranges::sort(radii);
  ASSERT_EQ(radii.size(), 3U);
  EXPECT_NEAR(radii[0], 0.35, 1e-12);
  EXPECT_NEAR(radii[1], 0.4, 1e-12);
  EXPECT_NEAR(radii[2], 0.6, 1e-12);
}

}  // namespace
}  // namespace cloud2csg
