#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>

#include "cloud2csg/extract.hpp"
#include "cloud2csg/family.hpp"
#include "cloud2csg/simplify.hpp"
#include "pipeline/strategies.hpp"
#include "support/known_solids.hpp"

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
  EXPECT_GE(test::membership_iou(result.tree, *model.tree, model.primitives), 0.999)
      << to_text(result.tree, model.primitives);
  EXPECT_LE(result.tree.size(), simplify(*model.tree).size()) << to_text(result.tree, model.primitives);
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
  const PointCloud cloud =
      sample_surface(*model.tree, model.primitives, {.count = k_points, .noise = noise, .seed = 3});
  const Extraction result = extract_csg(cloud, model.primitives, {.strategy = Strategy::cells});
  expect_truth(result, model, k_points);
  EXPECT_EQ(result.statistics.strategy, Strategy::cells);
  // What is tried first is the same.
  const Extraction automatic = extract_csg(cloud, model.primitives);
  EXPECT_EQ(automatic.tree, result.tree);
  EXPECT_EQ(automatic.statistics.fit.objective, result.statistics.fit.objective);
  EXPECT_TRUE(automatic.statistics.cells.has_value());
}

class FamilyByCells : public ::testing::TestWithParam<Family> {};
INSTANTIATE_TEST_SUITE_P(Models, FamilyByCells,
                         ::testing::Values(Family::chain, Family::plate, Family::random, Family::nest, Family::panel));

TEST_P(FamilyByCells, IsRightAndAsSmallAsTheTruth) {
  constexpr std::size_t k_points = 40'000;
  const Model model = make_family(GetParam(), {.primitives = 40});
  const PointCloud cloud =
      sample_surface(*model.tree, model.primitives, {.count = k_points, .noise = 0.005, .seed = 1});
  expect_truth(extract_csg(cloud, model.primitives, {.strategy = Strategy::cells}), model, k_points);
}

TEST_P(FamilyByCells, IsTheSameOnAnyNumberOfThreads) {
  const Model model = make_family(GetParam(), {.primitives = 30, .seed = 2});
  const PointCloud cloud = sample_surface(*model.tree, model.primitives, {.count = 40'000, .noise = 0.01, .seed = 1});
  const auto extract = [&](int threads) {
    return extract_csg(cloud, model.primitives, {.strategy = Strategy::cells}, {.threads = threads});
  };
  const Extraction expected = extract(1);
  for (const int threads : {2, 3}) {
    const Extraction result = extract(threads);
    EXPECT_EQ(result.tree, expected.tree) << threads;
    EXPECT_EQ(result.statistics.fit.objective, expected.statistics.fit.objective);
    EXPECT_EQ(result.statistics.cells->contradicted_points, expected.statistics.cells->contradicted_points);
    EXPECT_EQ(result.statistics.cells->speaking_points, expected.statistics.cells->speaking_points);
    EXPECT_EQ(result.statistics.unassigned_points, expected.statistics.unassigned_points);
  }
}

/// The same solid whatever it is called by, and whatever else was detected.
TEST(ByCells, LeavesOutWhatIsNotThere) {
  Model model = test::paper_model("m0");
  const PointCloud cloud = sample_surface(*model.tree, model.primitives, {.count = 6000, .noise = 0.005, .seed = 3});
  const std::size_t leaves = leaf_count(simplify(*model.tree));
  const std::size_t given = model.primitives.size();
  for (std::size_t k = 0; k < given; k += 3) {
    Primitive copy = model.primitives[k];
    copy.id += "_copy";
    model.primitives.push_back(copy);
  }
  model.primitives.push_back(test::placed("nowhere", Sphere{0.1}, {50, 50, 50}));
  const Extraction result = extract_csg(cloud, model.primitives);
  EXPECT_GE(test::membership_iou(result.tree, *model.tree, model.primitives), 0.999);
  EXPECT_EQ(leaf_count(result.tree), leaves) << to_text(result.tree, model.primitives);
  ASSERT_EQ(result.statistics.warnings.size(), 1U);
  EXPECT_NE(result.statistics.warnings[0].find("'nowhere'"), std::string::npos);
}

/// A box with a hollow of which the solid is not known, and one that stands in it: its points say that the box is solid
/// outside of it only, those of the box that it is solid everywhere.
class HollowThatIsNotKnown : public ::testing::Test {
 protected:
  HollowThatIsNotKnown() {
    const PrimitiveSet all{test::placed("a", Box{{2, 2, 2}}, {0, 0, 0}), test::placed("c", Sphere{0.6}, {0, 0, 0.2}),
                           test::placed("hollow", Box{{1.8, 1.8, 1.8}}, {0, 0, 0})};
    const CsgTree truth = parse_tree("(a - hollow) | c", all);
    cloud_ = sample_surface(truth, all, {.count = 4000, .noise = 0.002, .seed = 1});
    primitives_ = {all[0], all[1]};
  }

  [[nodiscard]] Extraction extract(const ExtractOptions& options, int threads = 1) const {
    return extract_csg(cloud_, primitives_, options, {.threads = threads});
  }

  PrimitiveSet primitives_;
  PointCloud cloud_;
};

TEST_F(HollowThatIsNotKnown, LeadsToTheSearchAndTheBetterTree) {
  const Extraction cells = extract({.strategy = Strategy::cells});
  const Extraction search = extract({.cell_trust = test::k_never_by_cells});
  const Extraction automatic = extract({});
  ASSERT_TRUE(cells.statistics.cells.has_value());
  EXPECT_FALSE(search.statistics.cells.has_value());
  EXPECT_GT(cells.statistics.cells->contradicted_points, 0.03 * cells.statistics.cells->speaking_points);
  EXPECT_FALSE(automatic.statistics.partitions.empty());
  const double of_cells = cells.statistics.fit.objective;
  const double of_search = search.statistics.fit.objective;
  EXPECT_EQ(automatic.statistics.fit.objective, std::max(of_cells, of_search));
  EXPECT_EQ(automatic.tree, of_cells > of_search ? cells.tree : search.tree);
  EXPECT_EQ(automatic.statistics.cells.has_value(), of_cells > of_search);
}

TEST_F(HollowThatIsNotKnown, IsTrustedWhereOneSaysSo) {
  const Extraction cells = extract({.strategy = Strategy::cells});
  const Extraction trusting = extract({.cell_trust = 0.01});
  EXPECT_TRUE(trusting.statistics.cells.has_value());
  EXPECT_TRUE(trusting.statistics.partitions.empty());
  EXPECT_EQ(trusting.tree, cells.tree);
}

TEST_F(HollowThatIsNotKnown, GivesTheSameOnAnyNumberOfThreads) {
  const Extraction expected = extract({}, 1);
  for (const int threads : {2, 3}) {
    const Extraction result = extract({}, threads);
    EXPECT_EQ(result.tree, expected.tree);
    EXPECT_EQ(result.statistics.cells.has_value(), expected.statistics.cells.has_value());
  }
}

nlohmann::json json_of(const Strategy strategy) {
  const Model model = test::paper_model("m2");
  const PointCloud cloud = sample_surface(*model.tree, model.primitives, {.count = 3000, .noise = 0.01, .seed = 3});
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
