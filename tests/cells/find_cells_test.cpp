#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>
#include <stop_token>
#include <tuple>

#include "cells/plain_crossings.hpp"
#include "cloud2csg/error.hpp"
#include "core/geometry/spatial_order.hpp"
#include "support/known_solids.hpp"
#include "support/scene.hpp"

namespace cloud2csg {
namespace {

constexpr double k_sampling_noise = 0.01;

CellOptions options_with(Precision precision) {
  return {
      .tolerances = segmentation_tolerances({}, k_sampling_noise), .noise = k_sampling_noise, .precision = precision};
}

test::PlainCrossings counted(const PointCloud& cloud, const PrimitiveSet& primitives, const CellOptions& options,
                             int threads) {
  const std::vector<std::uint32_t> order = spatial_order(cloud.positions, bounds_of(cloud.positions));
  return test::plain(count_crossings(cloud, order, reaching_primitives(primitives, bounds_of(cloud.positions), options),
                                     options.tolerances, {.threads = threads}));
}

/// Corners cut off a box: of planes that are not its own.
Polytope random_polytope(RandomStream& random) {
  const double size = random.uniform(0.3, 0.8);
  Polytope polytope;
  for (const Eigen::Index axis : {0, 1, 2}) {
    for (const double sign : {1.0, -1.0}) {
      polytope.planes.push_back({.normal = sign * Eigen::Vector3d::Unit(axis), .offset = size});
    }
    polytope.planes.push_back({.normal = test::random_direction(random), .offset = random.uniform(0.6, 0.9) * size});
  }
  return polytope;
}

/// Solids of every kind, some displaced, some that coincide; points on their faces and edges, near them, and anywhere.
test::Scene random_scene(RandomStream& random) {
  test::Scene scene = test::random_scene(1 + random.below(8), 1, random);
  if (random.chance(0.5)) {
    scene.primitives.push_back({.id = "polytope", .shape = random_polytope(random), .pose = test::random_pose(random)});
  }
  if (random.chance(0.3)) scene.primitives.push_back({.id = "expression", .shape = test::random_expression(random)});
  scene.cloud = test::random_cloud(scene.primitives, 1 + random.below(700), random);
  return scene;
}

RC_GTEST_PROP(CountCrossings, IsThePlainRuleAtEachPointOfAnyScene, (std::uint64_t seed)) {
  RandomStream random(seed);
  const test::Scene scene = random_scene(random);
  const CellOptions options{
      .tolerances = test::scene_tolerances(), .noise = test::k_scene_noise, .precision = Precision::full};
  RC_ASSERT(counted(scene.cloud, scene.primitives, options, 1) ==
            test::plain_crossings(scene.cloud, scene.primitives, options.tolerances));
}

class PaperCloud : public ::testing::TestWithParam<const char*> {
 protected:
  PaperCloud() : model_(test::paper_model(GetParam())) {
    cloud_ = sample_surface(model_, {.count = 40'000, .noise = k_sampling_noise, .seed = 4});
  }

  Model model_;
  PointCloud cloud_;
};
INSTANTIATE_TEST_SUITE_P(Models, PaperCloud, ::testing::Values("m0", "m1", "m2", "m3"));

/// Three chunks of points, on so many threads.
TEST_P(PaperCloud, IsCountedByThePlainRule) {
  const CellOptions options = options_with(Precision::full);
  const test::PlainCrossings expected = test::plain_crossings(cloud_, model_.primitives, options.tolerances);
  for (const int threads : {1, 2, 3}) {
    EXPECT_EQ(counted(cloud_, model_.primitives, options, threads), expected) << threads;
  }
}

TEST_P(PaperCloud, IsNearlyTheSameInSinglePrecision) {
  const test::PlainCrossings full = counted(cloud_, model_.primitives, options_with(Precision::full), 1);
  const test::PlainCrossings single = counted(cloud_, model_.primitives, options_with(Precision::single), 1);
  std::uint64_t all = 0;
  std::uint64_t different = 0;
  std::set<std::pair<Cell, Cell>> pairs;
  for (const auto& crossings : {full, single}) {
    for (const auto& [pair, units] : crossings.units) pairs.insert(pair);
  }
  const auto units_of = [](const test::PlainCrossings& crossings, const std::pair<Cell, Cell>& pair) {
    const auto found = crossings.units.find(pair);
    return found == crossings.units.end() ? std::uint64_t{0} : found->second;
  };
  for (const std::pair<Cell, Cell>& pair : pairs) {
    const auto [less, more] = std::minmax({units_of(full, pair), units_of(single, pair)});
    all += more;
    different += more - less;
  }
  EXPECT_LT(1000 * different, all);
  EXPECT_NE(all, 0U);
}

TEST_P(PaperCloud, HasTheSegmentsOfThePlainSegmentation) {
  const CellOptions options = options_with(Precision::full);
  const CellComplex complex = find_cells(cloud_, model_.primitives, options);
  const Segmentation segmentation = segment_points(cloud_, model_.primitives, options.tolerances);
  EXPECT_EQ(complex.unassigned, segmentation.unassigned);
  ASSERT_EQ(complex.points_of_primitive.size(), segmentation.points_of.size());
  for (std::size_t p = 0; p < segmentation.points_of.size(); ++p) {
    EXPECT_EQ(complex.points_of_primitive[p], segmentation.points_of[p].size()) << p;
  }
}

std::tuple<CellIndex, CellIndex, double, double, double> tied(const Patch& patch) {
  return {patch.first, patch.second, patch.first_in, patch.second_in, patch.area};
}

TEST_P(PaperCloud, GivesTheSameCellsOnAnyNumberOfThreads) {
  const CellComplex expected =
      find_cells(cloud_, model_.primitives, options_with(Precision::automatic), {.threads = 1});
  for (const int threads : {2, 3}) {
    const CellComplex complex =
        find_cells(cloud_, model_.primitives, options_with(Precision::automatic), {.threads = threads});
    EXPECT_EQ(complex.cells, expected.cells);
    EXPECT_TRUE(std::ranges::equal(complex.patches, expected.patches, {}, tied, tied));
    EXPECT_EQ(complex.points_of_primitive, expected.points_of_primitive);
    EXPECT_EQ(complex.unassigned, expected.unassigned);
    EXPECT_EQ(complex.order, expected.order);
  }
}

/// Cells and patches are what points and samples meet, in order.
TEST_P(PaperCloud, BecomesAComplexInOrder) {
  const CellOptions options = options_with(Precision::full);
  const CellComplex complex = find_cells(cloud_, model_.primitives, options);
  ASSERT_FALSE(complex.cells.empty());
  EXPECT_TRUE(complex.cells.front().empty());
  EXPECT_TRUE(std::ranges::is_sorted(complex.cells));
  EXPECT_EQ(std::ranges::adjacent_find(complex.cells), complex.cells.end());
  const auto ends = [](const Patch& patch) { return std::pair(patch.first, patch.second); };
  EXPECT_TRUE(std::ranges::is_sorted(complex.patches, {}, ends));
  EXPECT_EQ(std::ranges::adjacent_find(complex.patches, {}, ends), complex.patches.end());
  const test::PlainCrossings plain = test::plain_crossings(cloud_, model_.primitives, options.tolerances);
  const auto points_of = [&plain](const Cell& inner, const Cell& outer) {
    const auto found = plain.units.find({inner, outer});
    return found == plain.units.end() ? 0.0 : static_cast<double>(found->second) / k_sure_units;
  };
  double points = 0;
  for (const Patch& patch : complex.patches) {
    EXPECT_LT(patch.first, patch.second);
    EXPECT_EQ(patch.first_in, points_of(complex.cells[patch.first], complex.cells[patch.second]));
    EXPECT_EQ(patch.second_in, points_of(complex.cells[patch.second], complex.cells[patch.first]));
    EXPECT_TRUE(patch.area > 0 || patch.first_in + patch.second_in > 0);
    points += patch.first_in + patch.second_in;
  }
  double all = 0;
  for (const auto& [pair, units] : plain.units) all += static_cast<double>(units) / k_sure_units;
  EXPECT_EQ(points, all);
}

TEST(FindCells, GivesNothingOnAStop) {
  const PrimitiveSet primitives{test::placed("a", Sphere{1}, {0, 0, 0})};
  const PointCloud cloud = sample_surface({.primitives = primitives, .tree = CsgTree::leaf(0)}, {.count = 100});
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)find_cells(cloud, primitives, options_with(Precision::automatic), {.stop = stop.get_token()}),
               Cancelled);
}

TEST(MeasureVolumes, AreThoseOfBoxesThatOverlap) {
  const PrimitiveSet primitives{test::placed("a", Box{{2, 1, 1}}, {0, 0, 0}),
                                test::placed("b", Box{{2, 1, 1}}, {1, 0, 0})};
  const CellComplex complex{.cells = {{}, {0}, {0, 1}}, .patches = {}, .points_of_primitive = {1, 1}, .order = {}};
  const AlignedBox box(Eigen::Vector3d(-2, -1, -1), Eigen::Vector3d(3, 1, 1));
  const CellVolumes volumes = measure_volumes(complex, primitives, box, 40'000);
  EXPECT_NEAR(volumes.of_cell[0], 17, 0.3);
  EXPECT_NEAR(volumes.of_cell[1], 1, 0.1);
  EXPECT_NEAR(volumes.of_cell[2], 1, 0.1);
  EXPECT_NEAR(volumes.elsewhere, 1, 0.1);  // {1} is not among the cells
  EXPECT_NEAR(volumes.of_cell[0] + volumes.of_cell[1] + volumes.of_cell[2] + volumes.elsewhere, 20, 1e-9);
}

}  // namespace
}  // namespace cloud2csg
