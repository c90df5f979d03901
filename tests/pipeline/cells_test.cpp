#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "bench/families/family.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/extract.hpp"
#include "pipeline/strategies.hpp"
#include "support/known_solids.hpp"
#include "support/warnings.hpp"

/// Extraction by cells: on its own, and as what is tried first.
namespace cloud2csg {
namespace {

void expect_sane(const CellStatistics& cells, std::size_t primitives, std::size_t points) {
  EXPECT_GT(cells.cells, primitives / 2);
  EXPECT_GE(cells.patches + 1, cells.cells);  // nothing hangs in the air
  EXPECT_LT(cells.open_cells, cells.cells);
  EXPECT_GT(cells.speaking_points, 0.5 * static_cast<double>(points));
  EXPECT_LE(cells.speaking_points, static_cast<double>(points));
  EXPECT_GE(cells.contradicted_points, 0.0);
  EXPECT_LT(cells.contradicted_points, 0.03 * cells.speaking_points);
  std::size_t solved = cells.peeled;
  for (const std::size_t core : cells.cores) solved += core;
  EXPECT_LE(solved, primitives);
  EXPECT_GT(solved, 0U);
}

void expect_truth(const Extraction& result, const Model& model, std::size_t points) {
  EXPECT_GE(test::membership_iou(result.tree(), *model.tree, model.primitives), 0.999)
      << to_text(result.tree(), model.primitives);
  EXPECT_LE(result.tree().size(), simplify(*model.tree).size()) << to_text(result.tree(), model.primitives);
  EXPECT_LE(levels(result.tree()), levels(*model.tree)) << to_text(result.tree(), model.primitives);
  EXPECT_TRUE(result.statistics.complete);
  EXPECT_TRUE(result.statistics.warnings.empty());
  EXPECT_TRUE(result.statistics.partitions.empty());
  ASSERT_TRUE(result.statistics.cells.has_value());
  EXPECT_TRUE(result.statistics.cells->is_minimal);
  expect_sane(*result.statistics.cells, model.primitives.size(), points);
}

class PaperByCells : public ::testing::TestWithParam<std::tuple<const char*, double>> {};
INSTANTIATE_TEST_SUITE_P(Models, PaperByCells,
                         ::testing::Combine(::testing::Values("m0", "m1", "m2", "m3"), ::testing::Values(0.0, 0.01)));

TEST_P(PaperByCells, IsRightAndAsSmallAsTheTruth) {
  constexpr std::size_t k_points = 10'000;
  const auto& [name, noise] = GetParam();
  const Model model = test::paper_model(name);
  const PointCloud cloud = sample_surface(model, {.count = k_points, .noise = noise, .seed = 3});
  const Extraction result = extract_csg(cloud, model.primitives, {.strategy = Strategy::cells});
  expect_truth(result, model, k_points);
  EXPECT_EQ(result.statistics.strategy, Strategy::cells);
  // What is tried first is the same.
  const Extraction automatic = extract_csg(cloud, model.primitives);
  EXPECT_EQ(automatic.tree(), result.tree());
  EXPECT_EQ(automatic.statistics.fit.objective, result.statistics.fit.objective);
  EXPECT_TRUE(automatic.statistics.cells.has_value());
}

class FamilyByCells : public ::testing::TestWithParam<Family> {};
INSTANTIATE_TEST_SUITE_P(Models, FamilyByCells,
                         ::testing::Values(Family::chain, Family::plate, Family::random, Family::nest, Family::panel));

TEST_P(FamilyByCells, IsRightAndAsSmallAsTheTruth) {
  constexpr std::size_t k_points = 40'000;
  const Model model = make_family(GetParam(), {.primitives = 40});
  const PointCloud cloud = sample_surface(model, {.count = k_points, .noise = 0.005, .seed = 1});
  expect_truth(extract_csg(cloud, model.primitives, {.strategy = Strategy::cells}), model, k_points);
}

TEST_P(FamilyByCells, IsTheSameOnAnyNumberOfThreads) {
  const Model model = make_family(GetParam(), {.primitives = 30, .seed = 2});
  const PointCloud cloud = sample_surface(model, {.count = 40'000, .noise = 0.01, .seed = 1});
  const auto extract = [&](int threads) {
    return extract_csg(cloud, model.primitives, {.strategy = Strategy::cells}, {.threads = threads});
  };
  const Extraction expected = extract(1);
  for (const int threads : {2, 3}) {
    const Extraction result = extract(threads);
    EXPECT_EQ(result.tree(), expected.tree()) << threads;
    EXPECT_EQ(result.statistics.fit.objective, expected.statistics.fit.objective);
    EXPECT_EQ(result.statistics.cells->contradicted_points, expected.statistics.cells->contradicted_points);
    EXPECT_EQ(result.statistics.cells->speaking_points, expected.statistics.cells->speaking_points);
    EXPECT_EQ(result.statistics.unassigned_points, expected.statistics.unassigned_points);
  }
}

/// The same solid whatever it is called by, and whatever else was detected.
TEST(ByCells, LeavesOutWhatIsNotThere) {
  Model model = test::paper_model("m0");
  const PointCloud cloud = sample_surface(model, {.count = 6000, .noise = 0.005, .seed = 3});
  const std::size_t leaves = leaf_count(simplify(*model.tree));
  const std::size_t given = model.primitives.size();
  for (std::size_t k = 0; k < given; k += 3) {
    Primitive copy = model.primitives[k];
    copy.id += "_copy";
    model.primitives.push_back(copy);
  }
  model.primitives.push_back(test::placed("nowhere", Sphere{0.1}, {50, 50, 50}));
  const Extraction result = extract_csg(cloud, model.primitives);
  EXPECT_GE(test::membership_iou(result.tree(), *model.tree, model.primitives), 0.999);
  EXPECT_EQ(leaf_count(result.tree()), leaves) << to_text(result.tree(), model.primitives);
  ASSERT_EQ(result.statistics.warnings.size(), 1U);
  EXPECT_NE(result.statistics.warnings[0].find("'nowhere'"), std::string::npos);
}

/// A model of which one primitive was not detected: the points contradict each other.
struct Incomplete {
  const char* model;
  const char* missing;
  bool cells_are_taken;
};

class MissingPrimitive : public ::testing::TestWithParam<Incomplete> {
 protected:
  MissingPrimitive() {
    const Model model = test::paper_model(GetParam().model);
    cloud_ = sample_surface(model, {.count = 5000, .seed = 1});
    std::ranges::copy_if(model.primitives, std::back_inserter(primitives_),
                         [](const Primitive& primitive) { return primitive.id != GetParam().missing; });
  }

  [[nodiscard]] Extraction extract(const ExtractOptions& options) const {
    return extract_csg(cloud_, primitives_, options);
  }

  PrimitiveSet primitives_;
  PointCloud cloud_;
};
INSTANTIATE_TEST_SUITE_P(Models, MissingPrimitive,
                         ::testing::Values(Incomplete{"m1", "Box_0", true}, Incomplete{"m3", "housing", true}));

TEST_P(MissingPrimitive, LeadsToTheSearchAndTheTreeThatIsNoWorse) {
  const Extraction cells = extract({.strategy = Strategy::cells});
  const Extraction search = extract({.cell_trust = test::k_never_by_cells});
  const Extraction automatic = extract({});
  ASSERT_TRUE(cells.statistics.cells.has_value());
  EXPECT_FALSE(search.statistics.cells.has_value());
  EXPECT_TRUE(test::mentions(search.statistics.warnings, "did not merge well"));
  EXPECT_GT(cells.statistics.cells->contradicted_points, 0.03 * cells.statistics.cells->speaking_points);
  EXPECT_EQ(cells.statistics.fit.objective >= search.statistics.fit.objective, GetParam().cells_are_taken);
  const Extraction& better = GetParam().cells_are_taken ? cells : search;
  EXPECT_FALSE(automatic.statistics.partitions.empty());
  EXPECT_EQ(automatic.tree(), better.tree());
  EXPECT_EQ(automatic.statistics.fit.objective, better.statistics.fit.objective);
  EXPECT_EQ(automatic.statistics.warnings, better.statistics.warnings);
  EXPECT_EQ(automatic.statistics.cells.has_value(), GetParam().cells_are_taken);
}

TEST_P(MissingPrimitive, IsBorneWhereOneSaysSo) {
  const Extraction trusting = extract({.cell_trust = 0.01});
  EXPECT_TRUE(trusting.statistics.cells.has_value());
  EXPECT_TRUE(trusting.statistics.partitions.empty());
  EXPECT_EQ(trusting.tree(), extract({.strategy = Strategy::cells}).tree());
}

TEST_P(MissingPrimitive, GivesTheSameOnSeveralThreads) {
  const Extraction expected = extract_csg(cloud_, primitives_, {}, {.threads = 1});
  const Extraction result = extract_csg(cloud_, primitives_, {}, {.threads = 3});
  EXPECT_EQ(result.tree(), expected.tree());
  EXPECT_EQ(result.statistics.cells.has_value(), expected.statistics.cells.has_value());
}

/// The surface that `b` leaves in a missing `a` asks for the outside of `b` to be solid.
TEST(MissingFirstOperand, LeavesABoundedTree) {
  const auto sphere = [](const char* id, const Eigen::Vector3d& centre, double radius) {
    return Primitive{.id = id, .shape = Sphere{.radius = radius}, .pose = {.position = centre}};
  };
  const PrimitiveSet all{sphere("a", {0, 0, 0}, 2), sphere("b", {1.8, 0, 0}, 1), sphere("c", {-1.8, 0, 0}, 1),
                         sphere("d", {-2.4, 0, 0}, 0.5)};
  const CsgTree truth =
      subtract(unite(subtract(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2)), CsgTree::leaf(3));
  const PointCloud cloud =
      sample_surface({.primitives = all, .tree = truth}, {.count = 20'000, .noise = 0.01, .seed = 1});
  const PrimitiveSet given(all.begin() + 1, all.end());
  const auto is_unbounded = [&](const ExtractOptions& options) {
    return contains(extract_csg(cloud, given, options).tree(), std::vector<bool>(given.size(), false));
  };
  EXPECT_TRUE(is_unbounded({.cell_trust = test::k_never_by_cells})) << "else this test tests nothing";
  EXPECT_FALSE(is_unbounded({}));
}

/// Noise of the size of the features: most points are near several surfaces at once, and the cells say little.
TEST(NoisyCloud, IsClimbedOnByAllPoints) {
  std::size_t climbed = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Model model = make_family(Family::random, {.primitives = 12, .seed = seed});
    const PointCloud cloud = sample_surface(model, {.count = 5000, .noise = 0.08, .seed = seed});
    const auto objective_by = [&](const ExtractOptions& options) {
      return extract_csg(cloud, model.primitives, options).statistics.fit.objective;
    };
    const ExtractStatistics cells = extract_csg(cloud, model.primitives, {.strategy = Strategy::cells}).statistics;
    ASSERT_LT(cells.cells->speaking_points, 0.6 * 5000) << seed;
    const double best_start = std::max(cells.fit.objective, objective_by({.cell_trust = test::k_never_by_cells}));
    const Extraction automatic = extract_csg(cloud, model.primitives, {});
    EXPECT_GE(automatic.statistics.fit.objective, best_start - 1e-6 * std::abs(best_start)) << seed;
    climbed += automatic.statistics.fit.objective > best_start + 1 ? 1 : 0;
    const bool is_claimed = automatic.statistics.cells && automatic.statistics.cells->is_minimal;
    EXPECT_FALSE(is_claimed &&
                 automatic.tree() != extract_csg(cloud, model.primitives, {.strategy = Strategy::cells}).tree());
  }
  EXPECT_GT(climbed, 0U);
}

nlohmann::json json_of(const Strategy strategy) {
  const Model model = test::paper_model("m2");
  const PointCloud cloud = sample_surface(model, {.count = 3000, .noise = 0.01, .seed = 3});
  return nlohmann::json::parse(to_json(extract_csg(cloud, model.primitives, {.strategy = strategy}).statistics));
}

TEST(StatisticsJson, HasTheCells) {
  const nlohmann::json cells = json_of(Strategy::cells)["cells"];
  ASSERT_TRUE(cells.is_object());
  for (const char* key : {"cells", "patches", "open_cells", "peeled"}) {
    EXPECT_TRUE(cells[key].is_number_unsigned()) << key;
  }
  for (const char* key : {"speaking_points", "contradicted_points"}) EXPECT_TRUE(cells[key].is_number()) << key;
  EXPECT_TRUE(cells["cores"].is_array());
  EXPECT_EQ(cells["is_minimal"], true);
}

TEST(StatisticsJson, HasNullForTheCellsOfASearch) {
  const nlohmann::json json = json_of(Strategy::partition);
  ASSERT_TRUE(json.contains("cells"));
  EXPECT_TRUE(json["cells"].is_null());
}

}  // namespace
}  // namespace cloud2csg
