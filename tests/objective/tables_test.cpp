#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stop_token>
#include <string>

#include "cloud2csg/error.hpp"
#include "paper/objective/class_table.hpp"
#include "support/forced_target.hpp"
#include "support/scene.hpp"

namespace cloud2csg {
namespace {

std::vector<double> geometries(const RankClasses& table, const std::vector<CsgTree>& trees) {
  RankScratch scratch;
  std::vector<double> values;
  values.reserve(trees.size());
  for (const CsgTree& tree : trees) values.push_back(table.geometry(tree, scratch));
  return values;
}

std::vector<double> reference_geometries(const RankClasses& table, const std::vector<CsgTree>& trees) {
  std::vector<double> values;
  values.reserve(trees.size());
  for (const CsgTree& tree : trees) values.push_back(table.reference_geometry(tree));
  return values;
}

struct Case {
  test::Scene scene;
  std::vector<CsgTree> trees;
};

/// One in eight has more primitives than a byte holds ranks.
Case random_case(std::uint64_t seed) {
  RandomStream random(seed);
  const std::size_t primitives = random.chance(0.125) ? 120 + random.below(20) : 1 + random.below(12);
  Case result{.scene = test::random_scene(primitives, 1 + random.below(primitives > 100 ? 100 : 1200), random),
              .trees = {}};
  result.trees = test::random_formulas(primitives, 20, random);
  return result;
}

RC_GTEST_PROP(RankClassesTables, GeometryIsTheReferenceBitForBitOnEveryInstructionSet, (std::uint64_t seed)) {
  const Case random = random_case(seed);
  const RankClasses table = test::whole_table(random.scene);
  const std::vector<double> expected = reference_geometries(table, random.trees);
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    if (geometries(table, random.trees) != expected) RC_FAIL(std::string(hwy::TargetName(target)));
  }
}

RC_GTEST_PROP(RankClassesTables, TablesAreTheSameFromEveryInstructionSet, (std::uint64_t seed)) {
  const Case random = random_case(seed);
  const std::vector<double> expected = geometries(test::whole_table(random.scene), random.trees);
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    if (geometries(test::whole_table(random.scene), random.trees) != expected) {
      RC_FAIL(std::string(hwy::TargetName(target)));
    }
  }
}

RC_GTEST_PROP(RankClassesTables, GeometryDoesNotDependOnThreads, (std::uint64_t seed)) {
  const Case random = random_case(seed);
  const std::vector<RankClassesRequest> requests{
      {.primitives = test::all_of(random.scene.primitives), .all_points = true},
      {.primitives = test::all_of(random.scene.primitives), .stride = 3}};
  const PointPass expected = test::pass_over(random.scene, requests);
  for (const int threads : {2, 3, 8, 0}) {
    const PointPass pass = test::pass_over(random.scene, requests, {}, threads);
    RC_ASSERT(pass.points_of_primitive == expected.points_of_primitive);
    RC_ASSERT(pass.unassigned == expected.unassigned);
    for (std::size_t k = 0; k < requests.size(); ++k) {
      RC_ASSERT(pass.tables[k].point_count() == expected.tables[k].point_count());
      RC_ASSERT(pass.tables[k].class_count() == expected.tables[k].class_count());
      RC_ASSERT(geometries(pass.tables[k], random.trees) == geometries(expected.tables[k], random.trees));
    }
  }
}

/// Several chunks, so that threads have something to share.
TEST(RankClassesTables, LargeCloudsDoNotDependOnThreads) {
  RandomStream random(17);
  const test::Scene scene = test::random_scene(7, 60'000, random);
  const std::vector<CsgTree> trees = test::random_formulas(7, 10, random);
  const std::vector<RankClassesRequest> requests{{.primitives = test::all_of(scene.primitives), .all_points = true},
                                                 {.primitives = {0, 2, 3}},
                                                 {.primitives = {1, 2, 4, 5, 6}, .stride = 3}};
  for (const Precision precision : {Precision::full, Precision::single}) {
    const PointPass expected = test::pass_over(scene, requests, {}, 1, precision);
    for (const int threads : {2, 3, 8, 0}) {
      const PointPass pass = test::pass_over(scene, requests, {}, threads, precision);
      EXPECT_EQ(pass.points_of_primitive, expected.points_of_primitive);
      EXPECT_EQ(pass.unassigned, expected.unassigned);
      EXPECT_EQ(geometries(pass.tables[0], trees), geometries(expected.tables[0], trees));
      for (std::size_t k = 0; k < requests.size(); ++k) {
        EXPECT_EQ(pass.tables[k].class_count(), expected.tables[k].class_count());
        EXPECT_EQ(pass.tables[k].point_count(), expected.tables[k].point_count());
        EXPECT_EQ(pass.tables[k].geometry_bound(), expected.tables[k].geometry_bound());
      }
    }
  }
}

TEST(ClassTable, AbsorbedTablesAreAsIfFilledAtOnce) {
  constexpr std::uint32_t k_most_units = (1U << 23U) + 1;
  const auto fill = [](ClassTable& table, std::uint64_t seed) {
    RandomStream random(seed);
    std::vector<std::uint16_t> points(k_block_points);
    std::iota(points.begin(), points.end(), std::uint16_t{0});
    std::vector<std::uint32_t> classes(k_block_points);
    for (int block = 0; block < 40; ++block) {
      BlockKeys keys(2);
      for (std::uint32_t& word : keys.words) word = random.below(5);  // few, so that classes have many points
      compute_hashes(keys);
      table.find_or_insert(keys, points, classes);
      for (const std::uint32_t c : classes) {
        for (PackedContribution& sum : table.add_points(c, 1)) {
          sum += PackedContribution{random.below(k_most_units)} | PackedContribution{random.below(k_most_units)} << 32U;
        }
      }
    }
  };
  ClassTable at_once(3, 2);
  ClassTable first(3, 2);
  ClassTable second(3, 2);
  for (const std::uint64_t seed : {1U, 2U}) fill(at_once, seed);
  fill(first, 1);
  fill(second, 2);
  first.absorb(second);
  ASSERT_EQ(first.size(), at_once.size());
  EXPECT_EQ(first.point_count(), 80 * k_block_points);
  for (std::size_t c = 0; c < first.size(); ++c) {
    EXPECT_TRUE(std::ranges::equal(first.key(c), at_once.key(c)));
    for (std::size_t p = 0; p < 3; ++p) EXPECT_EQ(first.sum(c, p), at_once.sum(c, p));
    EXPECT_EQ(first.count(c), at_once.count(c));
  }
}

RC_GTEST_PROP(RankClassesTables, NoTreeExceedsTheBound, (std::uint64_t seed)) {
  const Case random = random_case(seed);
  for (const ObjectiveOptions& weights : test::all_weights()) {
    const RankClasses table = test::whole_table(random.scene, weights);
    for (const double geometry : geometries(table, random.trees)) RC_ASSERT(geometry <= table.geometry_bound());
    RC_ASSERT(table.geometry_bound() <= 2.0 * static_cast<double>(table.point_count()) * (1 + 1e-7));
  }
}

/// Where each class selects one primitive whatever the tree, the bound is reached by it.
TEST(RankClassesTables, TheBoundIsReachedByTheBestOfASinglePrimitive) {
  RandomStream random(5);
  const test::Scene scene = test::random_scene(1, 1, random);
  const RankClasses table = test::whole_table(scene);
  const std::vector<double> both = geometries(table, {CsgTree::leaf(0), complement(CsgTree::leaf(0))});
  EXPECT_EQ(table.geometry_bound(), std::max(both[0], both[1]));
}

RC_GTEST_PROP(RankClassesTables, ClassScoresSumUpToTheGeometry, (std::uint64_t seed)) {
  const Case random = random_case(seed);
  const RankClasses table = test::whole_table(random.scene);
  RankScratch scratch;
  for (const CsgTree& tree : random.trees) {
    const std::vector<float> scores = table.class_scores(tree, scratch);
    RC_ASSERT(scores.size() == table.class_count());
    RC_ASSERT(std::accumulate(scores.begin(), scores.end(), 0.0) == table.geometry(tree, scratch));
  }
}

/// Bottom-up over columns, as the listing of trees does it.
AlignedVector<std::int8_t> column_of(const RankClasses& table, const CsgTree& tree, std::size_t node) {
  const CsgNode& here = tree.nodes()[node];
  if (here.operation() == Operation::primitive) {
    const std::span<const std::int8_t> column = table.column(here.primitive());
    return {column.begin(), column.end()};
  }
  AlignedVector<std::int8_t> second = column_of(table, tree, tree.second_child(node));
  if (here.operation() == Operation::complement) {
    for (std::int8_t& rank : second) rank = static_cast<std::int8_t>(-rank);
    return second;
  }
  const AlignedVector<std::int8_t> first = column_of(table, tree, tree.first_child(node));
  AlignedVector<std::int8_t> out(table.padded_count());
  RankClasses::combine(here.operation(), first, second, out);
  return out;
}

RC_GTEST_PROP(RankClassesTables, ColumnsGiveTheGeometryOfTheirTree, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(12);
  const test::Scene scene = test::random_scene(primitives, 1 + random.below(2500), random);
  const RankClasses table = test::whole_table(scene);
  RC_ASSERT(table.padded_count() % 64 == 0U);
  RC_ASSERT(table.padded_count() >= table.class_count());
  const std::vector<CsgTree> trees = test::random_formulas(primitives, 10, random);
  RankScratch scratch;
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    for (const CsgTree& tree : trees) {
      const RankClasses::ColumnGeometry sums = table.column_geometry(column_of(table, tree, tree.root()));
      RC_ASSERT(sums.of_column == table.geometry(tree, scratch));
      RC_ASSERT(sums.of_negation == table.geometry(complement(tree), scratch));
    }
  }
}

TEST(RankClassesTables, RanksAreAPermutationInEveryClass) {
  RandomStream random(9);
  const test::Scene scene = test::random_scene(11, 2000, random);
  const RankClasses table = test::whole_table(scene);
  ASSERT_GT(table.class_count(), 100U);
  std::vector<float> values(table.class_count());
  std::vector<double> by_nearest(11, 0.0);
  for (std::size_t c = 0; c < table.class_count(); ++c) {
    std::vector<int> magnitudes;
    for (PrimitiveIndex p = 0; p < 11; ++p) magnitudes.push_back(std::abs(int{table.column(p)[c]}));
    values[c] = static_cast<float>(c % 17);
    by_nearest[static_cast<std::size_t>(std::ranges::find(magnitudes, 1) - magnitudes.begin())] += values[c];
    std::ranges::sort(magnitudes);
    for (int rank = 1; rank <= 11; ++rank) EXPECT_EQ(magnitudes[static_cast<std::size_t>(rank - 1)], rank);
  }
  EXPECT_EQ(table.sums_by_nearest(values), by_nearest);
}

TEST(RankClassesTables, NoTreeExceedsTheBoundInAnyClass) {
  RandomStream random(10);
  const test::Scene scene = test::random_scene(4, 2000, random);
  const RankClasses table = test::whole_table(scene);
  const std::vector<float> bounds(table.class_bounds().begin(), table.class_bounds().end());
  std::vector<float> best(table.class_count(), 0);
  RankScratch scratch;
  for (const CsgTree& tree : test::random_formulas(4, 3000, random)) {
    const std::vector<float> scores = table.class_scores(tree, scratch);
    for (std::size_t c = 0; c < scores.size(); ++c) best[c] = std::max(best[c], scores[c]);
  }
  EXPECT_EQ(best, bounds);
  EXPECT_NEAR(std::accumulate(bounds.begin(), bounds.end(), 0.0), table.geometry_bound(), 1e-6);
}

TEST(RankClassesTables, PointsThatAreNoMultipleOfTheBlockAllCount) {
  RandomStream random(13);
  const test::Scene scene = test::random_scene(4, 1030, random);
  for (const std::size_t count : {1U, 2U, 63U, 64U, 65U, 255U, 256U, 257U, 511U, 512U, 513U, 1030U}) {
    test::Scene part{.primitives = scene.primitives, .cloud = {}};
    for (std::size_t i = 0; i < count; ++i) {
      part.cloud.positions.push_back(scene.cloud.positions[i]);
      part.cloud.normals.push_back(scene.cloud.normals[i]);
    }
    for (const std::size_t stride : {1U, 2U, 7U, 256U, 300U, 5000U}) {
      const PointPass pass =
          test::pass_over(part, {{.primitives = test::all_of(part.primitives), .stride = stride, .all_points = true}});
      EXPECT_EQ(pass.tables[0].point_count(), (count + stride - 1) / stride) << count << ' ' << stride;
    }
  }
}

TEST(RankClassesTables, MembershipIsThatOfPlainSegmentation) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random(seed);
    const test::Scene scene = test::random_scene(1 + random.below(9), 700, random);
    const PointPass pass = test::pass_over(scene, {{.primitives = test::all_of(scene.primitives)}});
    const Segmentation plain = segment_points(scene.cloud, scene.primitives, test::scene_tolerances());
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
      EXPECT_EQ(pass.points_of_primitive[p], plain.points_of[p].size()) << seed << ' ' << p;
    }
    EXPECT_EQ(pass.unassigned, plain.unassigned) << seed;
    EXPECT_EQ(pass.tables[0].point_count(), scene.cloud.size() - plain.unassigned) << seed;
  }
}

TEST(RankClassesTables, NoRequestsStillSegment) {
  RandomStream random(17);
  const test::Scene scene = test::random_scene(3, 400, random);
  const PointPass pass = test::pass_over(scene, {});
  EXPECT_TRUE(pass.tables.empty());
  EXPECT_EQ(pass.points_of_primitive.size(), 3U);
}

TEST(RankClassesTables, ATableWithoutPointsScoresOnlySize) {
  PointCloud cloud;
  cloud.positions.push_back({100, 0, 0});
  cloud.normals.push_back(Eigen::Vector3d::UnitX());
  const test::Scene scene{.primitives = {{.id = "s", .shape = Sphere{1}}, {.id = "t", .shape = Sphere{2}}},
                          .cloud = cloud};
  const PointPass pass = test::pass_over(scene, {{.primitives = {0, 1}}});
  const RankClasses& table = pass.tables.front();
  EXPECT_EQ(table.point_count(), 0U);
  EXPECT_EQ(table.class_count(), 0U);
  EXPECT_EQ(table.geometry_bound(), 0.0);
  RankScratch scratch;
  EXPECT_EQ(table.geometry(unite(CsgTree::leaf(0), CsgTree::leaf(1)), scratch), 0.0);
  EXPECT_TRUE(table.class_scores(CsgTree::leaf(0), scratch).empty());
  EXPECT_EQ(pass.unassigned, 1U);
}

/// What simplify() may leave of a formula: no surface, so no point is near one.
TEST(RankClassesTables, NothingAndAllOfSpaceScoreNothing) {
  RandomStream random(19);
  for (const std::size_t primitives : {3U, 130U}) {
    const RankClasses table = test::whole_table(test::random_scene(primitives, 200, random));
    RankScratch scratch;
    for (const CsgTree& tree : {CsgTree::empty(), CsgTree::full()}) {
      EXPECT_EQ(table.geometry(tree, scratch), 0.0);
      EXPECT_EQ(table.reference_geometry(tree), 0.0);
      EXPECT_EQ(table.score(tree, scratch), -table.objective().alpha);
      EXPECT_EQ(table.class_scores(tree, scratch), std::vector<float>(table.class_count(), 0.0F));
    }
  }
}

TEST(RankClassesTables, StopsWhenAsked) {
  RandomStream random(23);
  const test::Scene scene = test::random_scene(3, 400, random);
  std::stop_source stop;
  stop.request_stop();
  const std::vector<RankClassesRequest> requests{{.primitives = {0, 1, 2}}};
  for (const int threads : {1, 2}) {
    EXPECT_THROW((void)build_rank_classes(scene.cloud, scene.primitives, requests,
                                          {.tolerances = test::scene_tolerances(), .noise = test::k_scene_noise},
                                          {.stop = stop.get_token(), .threads = threads}),
                 Cancelled);
  }
}

}  // namespace
}  // namespace cloud2csg
