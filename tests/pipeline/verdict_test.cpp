#include "pipeline/verdict.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/random.hpp"
#include "core/geometry/subset.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

using Json = nlohmann::json;

Model box_with_ball() {
  return {.primitives = {test::placed("box", Box{{2, 2, 2}}, {0, 0, 0}),
                         test::placed("ball", Sphere{.radius = 0.5}, {2, 0, 0})},
          .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
}

/// A flat lattice of 100 x 100 points, one apart.
Points flat_lattice() {
  Points points;
  for (int i = 0; i < 10'000; ++i) points.push_back({1.0 * (i % 100), 1.0 * (i / 100), 0.0});
  return points;
}

/// The points of the lattice in a rectangle.
std::vector<std::uint32_t> in_rectangle(const Points& points, double left, double right, double low, double high) {
  std::vector<std::uint32_t> in;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (points.x[i] >= left && points.x[i] <= right && points.y[i] >= low && points.y[i] <= high) in.push_back(i);
  }
  return in;
}

TEST(UnexplainedRegions, AreRankedByPointsWithPlaceAndSize) {
  const Points points = flat_lattice();
  std::vector<std::uint32_t> far = in_rectangle(points, 10, 19, 10, 19);
  const std::vector<std::uint32_t> larger = in_rectangle(points, 60, 89, 60, 79);
  far.insert(far.end(), larger.begin(), larger.end());
  const std::vector<UnexplainedRegion> regions = unexplained_regions(points, far);
  ASSERT_EQ(regions.size(), 2U);
  // Cubes at the rim of a region may hold more of the other points.
  EXPECT_GT(regions[0].points, 500U);
  EXPECT_LE(regions[0].points, 600U);
  EXPECT_LT((regions[0].place - Eigen::Vector3d(74.5, 69.5, 0)).norm(), 2);
  EXPECT_NEAR(regions[0].size, std::hypot(29, 19), 3);
  EXPECT_GT(regions[1].points, 64U);
  EXPECT_LE(regions[1].points, 100U);
  EXPECT_LT((regions[1].place - Eigen::Vector3d(14.5, 14.5, 0)).norm(), 2);
}

TEST(UnexplainedRegions, LeaveOutWhatNoiseScatters) {
  const Points points = flat_lattice();
  RandomStream random(7);
  std::vector<std::uint32_t> far;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (random.uniform() < 0.05) far.push_back(i);
  }
  ASSERT_GT(far.size(), 400U);
  EXPECT_TRUE(unexplained_regions(points, far).empty());
  EXPECT_TRUE(unexplained_regions(points, {}).empty());
}

RC_GTEST_PROP(UnexplainedRegions, MoveWithTheCloud, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  const Eigen::Vector3d centre = test::random_within(1, random);
  Points points;
  std::vector<std::uint32_t> far;
  for (std::uint32_t i = 0; i < 500; ++i) {
    points.push_back(test::random_within(1, random));
    if ((points[i] - centre).norm() < 0.5) far.push_back(i);
  }
  const std::vector<UnexplainedRegion> here = unexplained_regions(points, far);
  const Eigen::Vector3d shift(1024, -4096, 512);  // exact in binary
  Points moved;
  for (std::size_t i = 0; i < points.size(); ++i) moved.push_back(4 * points[i] + shift);
  const std::vector<UnexplainedRegion> there = unexplained_regions(moved, far);
  RC_ASSERT(here.size() == there.size());
  std::size_t count = 0;
  for (std::size_t k = 0; k < here.size(); ++k) {
    count += here[k].points;
    RC_ASSERT(here[k].points >= 12U);
    RC_ASSERT(here[k].points == there[k].points);
    RC_ASSERT((4 * here[k].place + shift - there[k].place).norm() < 1e-9);
  }
  RC_ASSERT(count <= far.size());
}

TEST(Verdict, OfARightTreeIsGood) {
  const Model model = box_with_ball();
  const PointCloud cloud = sample_surface(model, {.count = 4000, .noise = 0.002});
  const Verdict verdict = extract_csg(cloud, model.primitives).statistics.verdict;
  EXPECT_EQ(verdict.grade, Grade::good);
  EXPECT_TRUE(verdict.doubts.empty());
  EXPECT_TRUE(verdict.regions.empty());
  EXPECT_GT(verdict.share_within, 0.99);
  EXPECT_TRUE(to_text(verdict).starts_with("good: 99."));
}

TEST(Verdict, IsDoubtfulWhereAPrimitiveIsMissing) {
  const Model model = box_with_ball();
  const PointCloud cloud = sample_surface(model, {.count = 4000, .noise = 0.002});
  const ExtractStatistics statistics = extract_csg(cloud, {model.primitives[0]}).statistics;
  const Verdict& verdict = statistics.verdict;
  EXPECT_EQ(verdict.grade, Grade::doubtful);
  EXPECT_TRUE(to_text(verdict).starts_with("doubtful: "));
  EXPECT_NE(to_text(verdict).find("of the points contradict it"), std::string::npos);
  ASSERT_EQ(verdict.regions.size(), 1U);
  EXPECT_LT((verdict.regions[0].place - Eigen::Vector3d(2, 0, 0)).norm(), 0.1);
  EXPECT_NEAR(verdict.regions[0].size, std::sqrt(3.0), 0.1);  // the bounds of a ball of diameter 1
  EXPECT_EQ(region_lines(verdict).size(), 1U);

  const Json json = Json::parse(to_json(verdict));
  EXPECT_EQ(json, Json::parse(to_json(statistics))["verdict"]);
  EXPECT_EQ(json["grade"], "doubtful");
  EXPECT_EQ(json["text"], to_text(verdict));
  EXPECT_EQ(json["regions"][0]["points"], verdict.regions[0].points);
  EXPECT_TRUE(json["disagreement"].is_null());
}

TEST(Verdict, FailsWhereMostPointsContradictTheTree) {
  PointCloud cloud = sample_surface(box_with_ball(), {.count = 4000, .noise = 0.002});
  for (std::size_t i = cloud.size() * 2 / 5; i < cloud.size(); ++i) cloud.positions.z[i] += 10;
  const Verdict verdict = extract_csg(cloud, {box_with_ball().primitives[0]}).statistics.verdict;
  EXPECT_EQ(verdict.grade, Grade::failed);
  EXPECT_LT(verdict.share_within, 0.5);
}

TEST(Verdict, FailsForAConstantTree) {
  const Points points = flat_lattice();
  const Verdict empty = judge_fit({.primitives = {}, .tree = CsgTree::empty()}, {}, points);
  EXPECT_EQ(to_text(empty), "failed: the result is empty: no formula over the primitives explains the points");
  EXPECT_EQ(empty.share_within, 0);
  EXPECT_EQ(empty.unexplained_points, points.size());
  const Verdict full = judge_fit({.primitives = {}, .tree = CsgTree::full()}, {}, points);
  EXPECT_EQ(to_text(full), "failed: the result is all of space: normals may lead inward");
}

TEST(Verdict, IsDoubtfulForAnUnboundedSolid) {
  const Model model{.primitives = {box_with_ball().primitives[0]}, .tree = CsgTree::leaf(0)};
  PointCloud cloud = sample_surface(model, {.count = 4000, .noise = 0.002});
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.normals.set(i, -cloud.normals[i]);
  const Verdict verdict = extract_csg(cloud, model.primitives).statistics.verdict;
  EXPECT_EQ(verdict.grade, Grade::doubtful);
  EXPECT_NE(to_text(verdict).find("the solid is unbounded"), std::string::npos);
}

TEST(Verdict, CountsPointsThatContradictIt) {
  const Model box{.primitives = {test::placed("box", Box{{300, 300, 2}}, {50, 50, -1})}, .tree = CsgTree::leaf(0)};
  FitStatistics fit{.tolerances = {.distance = 0.5, .cosine = 0}, .far_points = {0, 9999}};
  const Points points = flat_lattice();
  EXPECT_EQ(judge_fit(box, fit, points).share_within, 0.9998);
  fit.unexplained_points = 1001;
  EXPECT_EQ(judge_fit(box, fit, points).grade, Grade::doubtful);
  fit.unexplained_points = 1000;
  EXPECT_EQ(judge_fit(box, fit, points).grade, Grade::good);
  fit.unexplained_points = 5001;
  EXPECT_EQ(judge_fit(box, fit, points).grade, Grade::failed);
}

/// What judged() says of this tree and the places of a cloud of a box.
ExtractStatistics statistics_of_tree(const Model& model) {
  const Model box{.primitives = {test::placed("box", Box{{2, 2, 2}}, {0, 0, 0})}, .tree = CsgTree::leaf(0)};
  Extraction result = reconstruct(sample_surface(box, {.count = 20'000, .noise = 0.002}));
  const LabelledPlaces places = label_places(result.cloud);
  result.model = model;
  return judged(std::move(result), Points(), places, Eigen::Vector3d::Zero(), {}).statistics;
}

TEST(Verdict, FailsWhereTheEmptySolidIsAsGood) {
  const ExtractStatistics elsewhere =
      statistics_of_tree({.primitives = {test::placed("box", Box{{2, 2, 2}}, {2.5, 0, 0})}, .tree = CsgTree::leaf(0)});
  EXPECT_GE(elsewhere.finding->disagreement, 1);
  EXPECT_EQ(elsewhere.verdict.grade, Grade::failed);

  const ExtractStatistics hollow =
      statistics_of_tree({.primitives = {test::placed("box", Box{{2, 2, 2}}, {0, 0, 0}),
                                         test::placed("hollow", Box{{1.2, 1.2, 1.2}}, {0, 0, 0})},
                          .tree = subtract(CsgTree::leaf(0), CsgTree::leaf(1))});
  EXPECT_EQ(hollow.verdict.grade, Grade::doubtful);
  EXPECT_NE(to_text(hollow.verdict).find("of its volume and surface, worst near"), std::string::npos);
  EXPECT_NEAR(hollow.verdict.bare_surface.value(), 1.44 / 5.44, 0.02);
  EXPECT_NE(to_text(hollow.verdict).find("of its surface has no points nearby"), std::string::npos);
}

TEST(Verdict, OfDetectionNamesWhatIsOnNoSurface) {
  FoundPrimitives found;
  found.prepared.cloud.positions = flat_lattice();
  found.prepared.scale.diagonal = 100;
  found.detection.distance_tolerance = 0.25;
  found.unexplained = in_rectangle(found.prepared.cloud.positions, 0, 19, 0, 39);
  EXPECT_EQ(to_text(judge_detection(found)), "good: 92 % of the points within 0.25 of the surface");
  ASSERT_EQ(judge_detection(found).regions.size(), 1U);

  found.unexplained = in_rectangle(found.prepared.cloud.positions, 0, 19, 0, 59);
  const Verdict doubtful = judge_detection(found);
  EXPECT_EQ(to_text(doubtful),
            "doubtful: 88 % of the points within 0.25 of the surface; 12 % of the points lie on no detected surface");
  EXPECT_LT((doubtful.regions.at(0).place - Eigen::Vector3d(9.5, 29.5, 0)).norm(), 2);
}

TEST(Verdict, OfPointsThatAreAllNoiseIsDoubtful) {
  PointCloud cloud;
  RandomStream random(1);
  for (int i = 0; i < 3000; ++i) cloud.positions.push_back({random.uniform(), random.uniform(), random.uniform()});
  const Verdict verdict = find_primitives(cloud).statistics.verdict;
  EXPECT_EQ(verdict.grade, Grade::doubtful);
  EXPECT_NE(to_text(verdict).find("of the cloud's diagonal, so it says little"), std::string::npos) << to_text(verdict);
}

TEST(FindPrimitives, GivesSurfacesThatBoundNoSolid) {
  PointCloud sheet;
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      sheet.positions.push_back({0.1 * i, 0.1 * j, 0});
      sheet.normals.push_back({0, 0, 1});
    }
  }
  const Extraction found = find_primitives(sheet);
  ASSERT_EQ(found.surfaces.size(), 1U);
  EXPECT_EQ(found.surfaces[0].surface.type, SurfaceType::plane);
  EXPECT_TRUE(found.model.primitives.empty());
  EXPECT_EQ(found.statistics.verdict.grade, Grade::doubtful);
  EXPECT_NE(to_text(found.statistics.verdict).find("the surfaces bound no solid"), std::string::npos);
  EXPECT_THROW((void)reconstruct(sheet), Error);

  const Primitive known = test::placed("known", Box{{6, 6, 1}}, {2.95, 2.95, 5});
  const Extraction with_known = find_primitives(sheet, {.known = {known}});
  ASSERT_EQ(with_known.model.primitives.size(), 1U);
  EXPECT_EQ(with_known.model.primitives[0].id, "known");
  EXPECT_EQ(with_known.statistics.verdict.grade, Grade::doubtful);
}

}  // namespace
}  // namespace cloud2csg
