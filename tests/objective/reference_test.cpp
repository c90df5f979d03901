#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/properties.hpp"
#include "support/request_points.hpp"

namespace cloud2csg {
namespace {

/// Some of the primitives, ascending; at least one.
std::vector<PrimitiveIndex> random_subset(std::size_t primitives, RandomStream& random) {
  std::vector<PrimitiveIndex> subset;
  for (PrimitiveIndex p = 0; p < primitives; ++p) {
    if (random.chance(0.7)) subset.push_back(p);
  }
  if (subset.empty()) subset.push_back(random.below(primitives));
  return subset;
}

/// E(t) without the cost of size from implicit_value() and implicit_gradient(): a third way, in columns of points.
double geometry_of_fields(const CsgTree& tree, const test::Scene& scene, std::span<const std::uint32_t> points,
                          const Objective& objective) {
  const std::vector<double> values = implicit_value(tree, scene.primitives, scene.cloud.positions);
  const Points slopes = implicit_gradient(tree, scene.primitives, scene.cloud.positions);
  double sum = 0;
  for (const std::uint32_t i : points) {
    const double cosine = slopes[i].normalized().dot(scene.cloud.normals[i]);
    sum += point_score(values[i], std::acos(std::clamp(cosine, -1.0, 1.0)), objective);
  }
  return sum;
}

/// Holds one table against the walk over each point and against whole columns of them.
void expect_reference(const RankClasses& table, const RankClassesRequest& request, const test::Scene& scene,
                      std::size_t trees, RandomStream& random) {
  const std::vector<std::uint32_t> points = test::PlainPoints(scene).of(request);
  test::expect_scores_of(table, points, scene, trees, random);
  Objective geometry_only = table.objective();
  geometry_only.alpha = 0;
  RankScratch scratch;
  for (const CsgTree& local : test::random_formulas(table.primitive_count(), trees, random)) {
    const CsgTree tree = renumber(local, table.primitives());
    const double reference = reference_objective(tree, scene.primitives, scene.cloud, points, geometry_only);
    ASSERT_NEAR(reference, geometry_of_fields(tree, scene, points, geometry_only), 1e-9 * reference + 1e-12);
    ASSERT_EQ(table.score(local, scratch),
              table.geometry(local, scratch) - table.objective().alpha * static_cast<double>(tree.size()));
  }
}

void compare_random_scene(std::size_t primitives, std::size_t points, std::size_t trees, RandomStream& random) {
  const test::Scene scene = test::random_scene(primitives, points, random);
  const RankClassesRequest whole{.primitives = test::all_of(scene.primitives), .all_points = true};
  const RankClassesRequest segmented{.primitives = random_subset(primitives, random)};
  const RankClassesRequest other{.primitives = random_subset(primitives, random), .all_points = random.chance(0.5)};
  // Together, one set's table is made from another's; one alone is made from the points.
  const std::vector<RankClassesRequest> requests =
      random.chance(0.7) ? std::vector{segmented, whole, other} : std::vector{random.chance(0.5) ? whole : segmented};
  for (const ObjectiveOptions& weights : test::all_weights()) {
    const PointPass pass = test::pass_over(scene, requests, weights);
    for (std::size_t k = 0; k < requests.size(); ++k) {
      expect_reference(pass.tables[k], requests[k], scene, trees, random);
    }
  }
}

RC_GTEST_PROP(RankClassesReference, AFewPrimitives, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(12);
  compare_random_scene(primitives, 1 + random.below(400), 6, random);
  test::fail_property_when_failed();
}

RC_GTEST_PROP(RankClassesReference, NoisyCloudsWhereScoresAreNotRoundNumbers, (std::uint64_t seed)) {
  RandomStream random(seed);
  test::Scene scene = test::random_scene(1 + random.below(6), 300, random);
  for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
    scene.cloud.positions.set(i, scene.cloud.positions[i] + test::random_within(0.02, random));
  }
  const RankClassesRequest request{.primitives = test::all_of(scene.primitives), .all_points = true};
  for (const ObjectiveOptions& weights : test::all_weights()) {
    expect_reference(test::pass_over(scene, {request}, weights).tables.front(), request, scene, 8, random);
  }
  test::fail_property_when_failed();
}

/// Around the limit of bytes, and the most that is promised.
TEST(RankClassesReference, ManyPrimitives) {
  RandomStream random(7);
  for (const std::size_t primitives : {30U, 63U, 64U, 126U, 127U, 128U, 129U, 200U}) {
    compare_random_scene(primitives, 60, 6, random);
  }
}

/// Single precision moves no score by more than 1e-5 of itself.
TEST(SinglePrecision, MovesScoresByLessThanAHundredThousandth) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    RandomStream random(seed);
    const std::size_t primitives = 2 + random.below(8);
    test::Scene scene = test::random_scene(primitives, 20'000, random);
    const Eigen::Vector3d offset = test::random_within(100, random);  // the frame's origin is elsewhere
    for (Primitive& primitive : scene.primitives) primitive.pose.position += offset;
    for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
      const Eigen::Vector3d noise{0.02 * random.normal(), 0.02 * random.normal(), 0.02 * random.normal()};
      scene.cloud.positions.set(i, scene.cloud.positions[i] + offset + noise);
    }
    const RankClasses full = test::whole_table(scene);
    const RankClasses single = test::whole_table(scene, {}, 1, Precision::single);
    RankScratch scratch;
    for (const CsgTree& tree : test::random_formulas(primitives, 20, random)) {
      const double expected = full.geometry(tree, scratch);
      EXPECT_NEAR(single.geometry(tree, scratch), expected, 1e-5 * expected) << to_text(tree, scene.primitives);
    }
  }
}

TEST(SinglePrecision, IsUsedWhereTheNoiseIsFarAboveRounding) {
  RandomStream random(3);
  const test::Scene scene = test::random_scene(4, 500, random);
  const std::vector<RankClassesRequest> requests{{.primitives = test::all_of(scene.primitives), .all_points = true}};
  const auto geometry = [&](double noise, Precision precision) {
    const PointPass pass = build_rank_classes(
        scene.cloud, scene.primitives, requests,
        {.tolerances = test::scene_tolerances(), .objective = {}, .noise = noise, .precision = precision});
    RankScratch scratch;
    return pass.tables.front().geometry(CsgTree::leaf(0), scratch);
  };
  EXPECT_EQ(geometry(0.02, Precision::automatic), geometry(0.02, Precision::single));
  EXPECT_NE(geometry(0.02, Precision::single), geometry(0.02, Precision::full));
  EXPECT_EQ(geometry(1e-5, Precision::automatic), geometry(1e-5, Precision::full));
  EXPECT_NE(geometry(1e-5, Precision::single), geometry(1e-5, Precision::full));
}

/// A face that is nearly flat because its sphere is large, or a half-space that is placed far away on its own plane.
TEST(SinglePrecision, IsLeftWhereLengthsAreLarge) {
  for (const double length : {1.0, 1e2, 1e4, 1e6, 1e8}) {
    const PrimitiveSet primitives{{.id = "block", .shape = Box{{2, 2, 2}}},
                                  {.id = "dome", .shape = Sphere{length}, .pose = {.position = {0, 0, 0.8 - length}}},
                                  {.id = "plane", .shape = HalfSpace{}, .pose = {.position = {length, -length, 0.5}}}};
    const CsgTree tree = intersect(unite(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2));
    RandomStream random(5);
    test::Scene scene{.primitives = primitives, .cloud = {}};
    for (int i = 0; i < 4000; ++i) {
      Eigen::Vector3d point = test::random_within(1, random);
      point.z() = (i % 2 == 0 ? 0.5 : 0.8) + 0.01 * random.normal();
      scene.cloud.positions.push_back(point);
      scene.cloud.normals.push_back(Eigen::Vector3d::UnitZ());
    }
    const auto geometry = [&](Precision precision) {
      const std::vector<RankClassesRequest> requests{{.primitives = {0, 1, 2}, .all_points = true}};
      const PointPass pass = build_rank_classes(
          scene.cloud, scene.primitives, requests,
          {.tolerances = segmentation_tolerances({}, 0.01), .objective = {}, .noise = 0.01, .precision = precision});
      RankScratch scratch;
      return pass.tables.front().geometry(tree, scratch);
    };
    const double expected = geometry(Precision::full);
    EXPECT_NEAR(geometry(Precision::automatic), expected, 1e-5 * expected) << length;
  }
}

/// Of every k points along the curve one is taken, and each counts as it does among all.
TEST(Stride, TakesOneOfEveryKPoints) {
  RandomStream random(9);
  const test::Scene scene = test::random_scene(5, 1000, random);
  const std::vector<PrimitiveIndex> all = test::all_of(scene.primitives);
  const std::vector<RankClassesRequest> requests{{.primitives = all, .all_points = true},
                                                 {.primitives = all, .stride = 7, .all_points = true}};
  const PointPass pass = test::pass_over(scene, requests);
  EXPECT_EQ(pass.tables[0].point_count(), 1000U);
  EXPECT_EQ(pass.tables[1].point_count(), 143U);
  RankScratch scratch;
  for (const CsgTree& tree : test::random_formulas(5, 10, random)) {
    EXPECT_LE(pass.tables[1].geometry(tree, scratch), pass.tables[0].geometry(tree, scratch));
  }
}

TEST(RankClassesReference, RelativeErrorIsBelowAMillionthWherePointsFit) {
  RandomStream random(11);
  const test::Scene scene = test::random_scene(9, 2000, random);
  std::vector<std::uint32_t> points(scene.cloud.size());
  std::iota(points.begin(), points.end(), 0U);
  RankScratch scratch;
  for (const ObjectiveOptions& weights : test::all_weights()) {
    const RankClasses table = test::whole_table(scene, weights);
    Objective geometry_only = table.objective();
    geometry_only.alpha = 0;
    for (const CsgTree& tree : test::random_formulas(9, 20, random)) {
      const double reference = reference_objective(tree, scene.primitives, scene.cloud, points, geometry_only);
      EXPECT_NEAR(table.geometry(tree, scratch), reference, 1e-6 * reference);
    }
  }
}

TEST(PointScore, IsTheFormulaOfThePaper) {
  const Objective objective{.alpha = 0, .beta = 100, .gamma = 18 / std::numbers::pi};
  EXPECT_DOUBLE_EQ(point_score(0, 0, objective), 2.0);
  EXPECT_DOUBLE_EQ(point_score(0.01, 0, objective), 1 + std::exp(-1.0));
  EXPECT_DOUBLE_EQ(point_score(-0.01, 0, objective), 1 + std::exp(-1.0));
  EXPECT_NEAR(point_score(1e6, std::numbers::pi / 18, objective), std::exp(-1.0), 1e-15);
}

TEST(Resolve, DerivesWhatIsAbsent) {
  const Objective derived = resolve({}, 1000, 0.02);
  EXPECT_DOUBLE_EQ(derived.alpha, std::log(1000.0));
  EXPECT_DOUBLE_EQ(derived.beta, 50.0);
  EXPECT_DOUBLE_EQ(derived.gamma, 18 / std::numbers::pi);
  const Objective given = resolve({.alpha = 0.0, .beta = 100, .gamma = 2}, 1000, 0.02);
  EXPECT_DOUBLE_EQ(given.alpha, 0.0);
  EXPECT_DOUBLE_EQ(given.beta, 100.0);
  EXPECT_DOUBLE_EQ(given.gamma, 2.0);
  EXPECT_DOUBLE_EQ(resolve({}, 0, 0.02).alpha, 0.0);
}

TEST(ReferenceObjective, ScoresAPerfectSphereByHand) {
  const PrimitiveSet primitives{{.id = "s", .shape = Sphere{.radius = 1}}};
  PointCloud cloud;
  for (int axis = 0; axis < 3; ++axis) {
    cloud.positions.push_back(Eigen::Vector3d::Unit(axis));
    cloud.normals.push_back(Eigen::Vector3d::Unit(axis));
  }
  const Objective objective{.alpha = 0.25, .beta = 100, .gamma = 18 / std::numbers::pi};
  const std::vector<std::uint32_t> all{0, 1, 2};
  const std::vector<std::uint32_t> one{1};
  EXPECT_DOUBLE_EQ(reference_objective(CsgTree::leaf(0), primitives, cloud, all, objective), 6 - 0.25);
  EXPECT_DOUBLE_EQ(reference_objective(CsgTree::leaf(0), primitives, cloud, one, objective), 2 - 0.25);
  // Turned inside out the distances fit, the normals are 180 degrees off.
  EXPECT_NEAR(reference_objective(complement(CsgTree::leaf(0)), primitives, cloud, all, objective), 3 - 0.5, 1e-12);
}

}  // namespace
}  // namespace cloud2csg
