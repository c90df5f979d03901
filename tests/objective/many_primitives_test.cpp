#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "support/properties.hpp"
#include "support/request_points.hpp"

namespace cloud2csg {
namespace {

/// Half the side of the cube that the solids are spread in; they are about one unit wide.
constexpr double k_half_side = 6;

Shape random_small_shape(RandomStream& random) {
  const double a = random.uniform(0.3, 1.2);
  const double b = random.uniform(0.2, 0.8);
  switch (random.below(10)) {
    case 0:
      return Cylinder{.radius = b, .height = 2 * a};
    case 1:
      return Cone{.radius_bottom = a, .radius_top = random.chance(0.5) ? 0.0 : b, .height = a};
    case 2:
      return Torus{.major_radius = a, .minor_radius = std::min(a, b)};
    case 3:
      return Polytope{
          .planes = {{{-1, 0, 0}, a}, {{0, -1, 0}, b}, {{0, 0, -1}, a}, {{0.6, 0.8, 0}, a}, {{0, 0, 1}, b}}};
    case 4:
    case 5:
    case 6:
      return Sphere{.radius = a};
    default:
      return Box{.size = {2 * a, 2 * b, a}};
  }
}

Primitive random_small_primitive(RandomStream& random) {
  Primitive primitive{.id = "p", .shape = random_small_shape(random), .pose = test::random_pose(random)};
  primitive.pose.position = test::random_within(k_half_side, random);
  if (random.chance(0.03)) primitive.shape = test::random_expression(random);
  if (random.chance(0.05)) primitive.displacement = Displacement{.frequency = random.uniform(0.5, 6)};
  return primitive;
}

/// Near a random solid's surface, mostly with a normal that fits it; one in eight is anywhere.
void add_random_point(test::Scene& scene, RandomStream& random) {
  const Primitive& primitive = scene.primitives[random.below(scene.primitives.size())];
  const Points start = test::single(primitive.pose.position + test::random_within(1.5, random));
  Eigen::Vector3d point = start[0] - signed_distance(primitive, start)[0] * gradient(primitive, start)[0];
  if (random.chance(0.5)) point += test::random_within(test::k_scene_noise, random);
  if (random.chance(0.125)) point = test::random_within(1.5 * k_half_side, random);
  if (!point.allFinite() || point.norm() > 100) return;  // an expression may throw it far
  scene.cloud.positions.push_back(point);
  scene.cloud.normals.push_back(
      test::random_normal(random.chance(0.7) ? PrimitiveSet{primitive} : scene.primitives, point, random));
}

/// Some are copies of others, and at most two half-spaces hide half of everything.
test::Scene random_wide_scene(std::size_t primitives, std::size_t points, RandomStream& random) {
  test::Scene scene;
  for (std::size_t p = 0; p < primitives; ++p) {
    const bool is_copy = p > 0 && random.chance(0.1);
    scene.primitives.push_back(is_copy ? Primitive(scene.primitives[random.below(p)]) : random_small_primitive(random));
    scene.primitives.back().id += std::to_string(p);
  }
  for (std::size_t half_spaces = random.below(3); half_spaces > 0; --half_spaces) {
    scene.primitives[random.below(primitives)].shape = HalfSpace{};
  }
  while (scene.cloud.size() < points) add_random_point(scene, random);
  return scene;
}

/// A primitive with those whose centres are nearest, ascending.
std::vector<PrimitiveIndex> neighbours(const PrimitiveSet& primitives, std::size_t count, RandomStream& random) {
  const Eigen::Vector3d centre = primitives[random.below(primitives.size())].pose.position;
  std::vector<PrimitiveIndex> nearest = test::all_of(primitives);
  std::ranges::sort(nearest, std::less(),
                    [&](PrimitiveIndex p) { return (primitives[p].pose.position - centre).squaredNorm(); });
  nearest.resize(std::min(count, nearest.size()));
  std::ranges::sort(nearest);
  return nearest;
}

std::vector<PrimitiveIndex> some_of(const std::vector<PrimitiveIndex>& set, RandomStream& random) {
  std::vector<PrimitiveIndex> some;
  for (const PrimitiveIndex p : set) {
    if (random.chance(0.5)) some.push_back(p);
  }
  if (some.empty()) some.push_back(set[random.below(set.size())]);
  return some;
}

/// Some of its sides go through points, others are at infinity.
AlignedBox random_region(const test::Scene& scene, RandomStream& random) {
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  AlignedBox region(Eigen::Vector3d::Constant(-k_infinity), Eigen::Vector3d::Constant(k_infinity));
  const auto any_point = [&] { return scene.cloud.positions[random.below(scene.cloud.size())]; };
  for (int axis = 0; axis < 3; ++axis) {
    if (random.chance(0.4)) region.min()[axis] = any_point()[axis];
    if (random.chance(0.4)) region.max()[axis] = any_point()[axis];
  }
  return region;
}

RankClassesRequest random_request(const test::Scene& scene, RandomStream& random) {
  const std::size_t size = random.chance(0.15) ? 25 + random.below(20) : 1 + random.below(10);
  RankClassesRequest request{.primitives = neighbours(scene.primitives, size, random)};
  if (random.chance(0.4)) request.owners = some_of(request.primitives, random);
  if (random.chance(0.2)) request.stride = 2 + random.below(3);
  request.all_points = random.chance(0.15);
  request.without_strangers = random.chance(0.5);
  if (random.chance(0.3)) request.region = random_region(scene, random);
  return request;
}

/// A request that may be answered from the other's table, or only nearly.
RankClassesRequest random_part_of(const RankClassesRequest& whole, RandomStream& random) {
  RankClassesRequest part{.primitives = some_of(whole.primitives, random), .owners = {}, .stride = whole.stride};
  if (random.chance(0.4)) part.owners = some_of(part.primitives, random);
  part.all_points = random.chance(0.2);
  part.without_strangers = random.chance(0.8) ? whole.without_strangers : !whole.without_strangers;
  if (random.chance(0.8)) part.region = whole.region;
  return part;
}

std::vector<RankClassesRequest> random_requests(const test::Scene& scene, std::size_t count, RandomStream& random) {
  std::vector<RankClassesRequest> requests;
  while (requests.size() < count) {
    const bool is_part = !requests.empty() && random.chance(0.5);
    requests.push_back(is_part ? random_part_of(requests[random.below(requests.size())], random)
                               : random_request(scene, random));
  }
  return requests;
}

void compare_with_plain_points(const test::Scene& scene, std::size_t requests, RandomStream& random) {
  const std::vector<RankClassesRequest> asked = random_requests(scene, requests, random);
  const PointPass pass = test::pass_over(scene, asked);
  const test::PlainPoints plain(scene);
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    ASSERT_EQ(pass.points_of_primitive[p], plain.segmentation().points_of[p].size()) << p;
  }
  ASSERT_EQ(pass.unassigned, plain.segmentation().unassigned);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    ASSERT_TRUE(std::ranges::equal(pass.tables[k].primitives(), asked[k].primitives));
    test::expect_scores_of(pass.tables[k], plain.of(asked[k]), scene, 4, random);
  }
}

RC_GTEST_PROP(ManyPrimitives, AreJudgedByThePointsOfThePlainDefinition, (std::uint64_t seed)) {
  RandomStream random(seed);
  const test::Scene scene = random_wide_scene(33 + random.below(88), 1 + random.below(2000), random);
  compare_with_plain_points(scene, 1 + random.below(8), random);
  test::fail_property_when_failed();
}

/// More than a chunk of points.
TEST(ManyPrimitives, AreJudgedByThePointsOfThePlainDefinitionInLargeClouds) {
  RandomStream random(29);
  const test::Scene scene = random_wide_scene(70, 40'000, random);
  compare_with_plain_points(scene, 12, random);
}

/// Below the number from which on only those near a block are looked at.
RC_GTEST_PROP(FewPrimitives, AreJudgedByThePointsOfThePlainDefinition, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = random.chance(0.3) ? 31 + random.below(2) : 1 + random.below(12);
  const test::Scene scene = random.chance(0.5) ? random_wide_scene(primitives, 1 + random.below(1000), random)
                                               : test::random_scene(primitives, 1 + random.below(600), random);
  compare_with_plain_points(scene, 1 + random.below(6), random);
  test::fail_property_when_failed();
}

TEST(FewPrimitives, StridesGoOnAcrossChunks) {
  RandomStream random(31);
  const test::Scene scene = random_wide_scene(6, 40'000, random);
  compare_with_plain_points(scene, 6, random);
}

void expect_equal_tables(const RankClasses& table, const RankClasses& expected, RandomStream& random) {
  ASSERT_EQ(table.point_count(), expected.point_count());
  ASSERT_EQ(table.class_count(), expected.class_count());
  ASSERT_EQ(table.geometry_bound(), expected.geometry_bound());
  RankScratch scratch;
  for (const CsgTree& tree : test::random_formulas(table.primitive_count(), 8, random)) {
    ASSERT_EQ(table.geometry(tree, scratch), expected.geometry(tree, scratch));
  }
}

TEST(ManyPrimitives, TablesDoNotDependOnThreads) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    RandomStream random(seed);
    const test::Scene scene = random_wide_scene(33 + random.below(60), 40'000, random);
    const std::vector<RankClassesRequest> requests = random_requests(scene, 6, random);
    for (const Precision precision : {Precision::full, Precision::single}) {
      const PointPass expected = test::pass_over(scene, requests, {}, 1, precision);
      const PointPass pass = test::pass_over(scene, requests, {}, 3, precision);
      EXPECT_EQ(pass.points_of_primitive, expected.points_of_primitive);
      EXPECT_EQ(pass.unassigned, expected.unassigned);
      for (std::size_t k = 0; k < requests.size(); ++k) expect_equal_tables(pass.tables[k], expected.tables[k], random);
    }
  }
}

/// Whole blocks of points lie on the plane where two regions meet, which is no round number in single precision.
TEST(ManyPrimitives, OnTheSideThatRegionsShareCountOnce) {
  RandomStream random(11);
  for (const double side : {0.0, 0.1, -1.0 / 3, 1e-3}) {
    test::Scene scene{.primitives = {{.id = "p", .shape = Box{{4, 4, 4}}, .pose = {}}}, .cloud = {}};
    for (int i = 0; i < 3000; ++i) {
      scene.cloud.positions.push_back({side, random.uniform(-1, 1), random.uniform(-1, 1)});
      scene.cloud.normals.push_back({0, 0, 1});
    }
    scene.cloud.positions.push_back({7.7, 3, 3});  // the middle of all is no round number either
    scene.cloud.normals.push_back({1, 0, 0});
    constexpr double k_infinity = std::numeric_limits<double>::infinity();
    AlignedBox below(Eigen::Vector3d::Constant(-k_infinity), Eigen::Vector3d::Constant(k_infinity));
    AlignedBox above = below;
    below.max().x() = above.min().x() = side;
    const std::vector<RankClassesRequest> requests{{.primitives = {0}, .all_points = true, .region = below},
                                                   {.primitives = {0}, .all_points = true, .region = above}};
    for (const Precision precision : {Precision::full, Precision::single}) {
      const PointPass pass = test::pass_over(scene, requests, {}, 1, precision);
      EXPECT_EQ(pass.tables[0].point_count(), 0U) << side;
      EXPECT_EQ(pass.tables[1].point_count(), 3001U) << side;
    }
  }
}

/// A request alone is answered from the points, together with one that holds it from that one's classes.
RC_GTEST_PROP(ManyPrimitives, TablesAreTheSameFromALargerOne, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = random.chance(0.5) ? 33 + random.below(60) : 2 + random.below(31);
  const test::Scene scene = random_wide_scene(primitives, 1 + random.below(3000), random);
  const std::size_t size = 1 + random.below(RankClasses::k_shared_limit);
  RankClassesRequest whole{.primitives = neighbours(scene.primitives, size, random)};
  whole.stride = 1 + random.below(2);
  whole.without_strangers = random.chance(0.5);
  if (random.chance(0.3)) whole.region = random_region(scene, random);
  const RankClassesRequest part = random_part_of(whole, random);
  const PointPass both = test::pass_over(scene, {part, whole});
  expect_equal_tables(both.tables[0], test::pass_over(scene, {part}).tables[0], random);
  expect_equal_tables(both.tables[1], test::pass_over(scene, {whole}).tables[0], random);
  test::fail_property_when_failed();
}

/// Single precision sees the same primitives but for points at the very limit of a tolerance or on an edge, which are
/// moved off it here.
TEST(ManyPrimitives, InSinglePrecisionHaveNearlyTheSamePoints) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    RandomStream random(seed);
    test::Scene scene = random_wide_scene(80, 8000, random);
    const Eigen::Vector3d offset = test::random_within(100, random);
    for (Primitive& primitive : scene.primitives) primitive.pose.position += offset;
    for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
      scene.cloud.positions.set(i, scene.cloud.positions[i] + offset + test::random_within(0.01, random));
    }
    const PointPass full = test::pass_over(scene, {});
    const PointPass single = test::pass_over(scene, {}, {}, 1, Precision::single);
    EXPECT_LT(full.unassigned, 6000U);
    EXPECT_NEAR(static_cast<double>(single.unassigned), static_cast<double>(full.unassigned), 4);
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
      EXPECT_NEAR(static_cast<double>(single.points_of_primitive[p]), static_cast<double>(full.points_of_primitive[p]),
                  2);
    }
  }
}

}  // namespace
}  // namespace cloud2csg
