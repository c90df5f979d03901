#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "cloud2csg/extract.hpp"
#include "pipeline/strategies.hpp"
#include "support/any_profile.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

Extraction extraction_of(const char* name, const ExtractOptions& options = {}) {
  const Model model = test::paper_model(name);
  const PointCloud cloud = sample_surface(model, {.count = 5000, .noise = 0.01, .seed = 2});
  return extract_csg(cloud, model.primitives, options, {.threads = 2});
}

TEST(StatisticsJson, HasEveryKeyOfTheContract) {
  const nlohmann::json json = nlohmann::json::parse(to_json(extraction_of("m0").statistics));
  for (const char* key : {"version", "strategy", "parallel", "threads", "seed", "complete", "points", "primitives",
                          "clique_histogram", "seconds", "search", "merge", "tree", "fit", "warnings"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  for (const char* key : {"read", "clean", "normals", "detect", "segment", "overlap", "partition", "classes", "search",
                          "merge", "simplify", "write", "extraction", "total"}) {
    ASSERT_TRUE(json["seconds"].contains(key)) << key;
    EXPECT_GE(json["seconds"][key].get<double>(), 0.0) << key;
  }
  for (const char* key : {"generations", "evaluations"}) EXPECT_TRUE(json["search"].contains(key)) << key;
  for (const char* key : {"size", "leaves", "depth", "levels"}) EXPECT_TRUE(json["tree"].contains(key)) << key;
  for (const char* key :
       {"objective", "rms_distance", "p95_distance", "rms_angle_deg", "p95_angle_deg", "unexplained_points"}) {
    EXPECT_TRUE(json["fit"][key].is_number()) << key;
  }
  EXPECT_EQ(json["strategy"], "auto");
  EXPECT_EQ(json["parallel"], "both");
  EXPECT_EQ(json["threads"], 2);
  EXPECT_EQ(json["points"], 5000);
  EXPECT_EQ(json["primitives"], 17);
  EXPECT_EQ(json["clique_histogram"], (std::vector<int>{0, 8, 4, 0, 1, 1}));
}

TEST(StatisticsJson, NamesTheWaysOfTheMerge) {
  ExtractStatistics statistics;
  statistics.merge.ways = {MergeWay::single, MergeWay::paper, MergeWay::dominance, MergeWay::largest_common_subtree,
                           MergeWay::joint,  MergeWay::search};
  statistics.warnings = {"a \"quoted\" warning"};
  const nlohmann::json json = nlohmann::json::parse(to_json(statistics));
  EXPECT_EQ(json["merge"]["ways"],
            (std::vector<std::string>{"single", "paper", "dominance", "largest_common_subtree", "joint", "search"}));
  EXPECT_EQ(json["warnings"], (std::vector<std::string>{"a \"quoted\" warning"}));
}

TEST(StatisticsJson, TellsTheStepsToTheTree) {
  const auto names = [](const nlohmann::json& json) {
    std::vector<std::string> result;
    for (const nlohmann::json& step : json["steps"]) result.push_back(step["name"]);
    return result;
  };
  const Extraction by_cells = extraction_of("m0");
  const nlohmann::json cells = nlohmann::json::parse(to_json(by_cells.statistics));
  EXPECT_EQ(names(cells), (std::vector<std::string>{"decomposition", "simplification"}));
  EXPECT_EQ(cells["steps"].back()["size"], by_cells.tree().size());
  EXPECT_EQ(cells["cells"]["least_leaves"], leaf_count(by_cells.tree()));
  const Extraction by_partitions = extraction_of("m0", {.strategy = Strategy::partition});
  const nlohmann::json partitions = nlohmann::json::parse(to_json(by_partitions.statistics));
  EXPECT_EQ(names(partitions), (std::vector<std::string>{"merged partitions", "simplification"}));
}

TEST(Statistics, MeasureTheTree) {
  const Extraction result = extraction_of("m0");
  EXPECT_EQ(result.statistics.tree.size, result.tree().size());
  EXPECT_EQ(result.statistics.tree.leaves, leaf_count(result.tree()));
  EXPECT_EQ(result.statistics.tree.depth, depth(result.tree()));
  EXPECT_GE(result.statistics.before_simplification.size, result.tree().size());
}

TEST(Statistics, PriceTheTreeByItsLeaves) {
  const ClosedPath star = test::regular_path(7, 1);
  const PrimitiveSet primitives{
      test::placed("ball", Sphere{.radius = 1}, {0, 0, 0}),
      test::placed("star", Extrusion{.profile = {.paths = {star}}, .height = 1}, {0, 0, 0}),
      test::placed("unused", Extrusion{.profile = {.paths = {star}}, .height = 2}, {0, 0, 0})};
  const CsgTree tree = subtract(unite(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(1));
  const TreeStatistics statistics = statistics_of(tree, primitives);
  EXPECT_EQ(statistics.price, 3.6) << "without errors of rounding";
  EXPECT_EQ(statistics.operations, 4U) << "two profiles and two combinations";
}

TEST(Statistics, FitIsThatOfTheNoise) {
  const Extraction result = extraction_of("m0");
  const FitStatistics& fit = result.statistics.fit;
  EXPECT_NEAR(result.statistics.noise, 0.01, 0.002);
  EXPECT_NEAR(fit.rms_distance, 0.01, 0.002);
  EXPECT_NEAR(fit.p95_distance, 0.02, 0.004);
  EXPECT_GT(fit.rms_angle_deg, 0.0);
  EXPECT_GT(fit.p95_angle_deg, 0.0);
  EXPECT_LE(fit.p95_angle_deg, 180.0);
  EXPECT_LT(fit.rms_angle_deg, 40.0);  // noise across edges turns normals by a right angle
  EXPECT_GT(fit.objective, 5000.0);
  EXPECT_LT(fit.objective, 10'000.0);
}

TEST(Statistics, ObjectiveIsThatOfTheReference) {
  const Model model = test::paper_model("m0");
  const PointCloud cloud = sample_surface(model, {.count = 2000, .noise = 0.01, .seed = 2});
  const Extraction result = extract_csg(cloud, model.primitives);
  std::vector<std::uint32_t> all(cloud.size());
  std::iota(all.begin(), all.end(), 0U);
  const double reference = reference_objective(result.tree(), model.primitives, cloud, all,
                                               resolve({}, cloud.size(), result.statistics.noise));
  EXPECT_NEAR(result.statistics.fit.objective, reference, 1e-9 * std::abs(reference));
}

TEST(Statistics, PartitionsCoverThePrimitives) {
  for (ExtractOptions options : test::all_searches()) {
    options.search = paper_ga_options();
    const Extraction result = extraction_of("m1", options);
    std::vector<bool> covered(4, false);
    for (const PartitionStatistics& partition : result.statistics.partitions) {
      for (const PrimitiveIndex p : partition.primitives) covered[p] = true;
      EXPECT_GT(partition.points, 0U);
      EXPECT_GT(partition.classes, 0U);
      EXPECT_GT(partition.evaluations, 0U);
      EXPECT_GT(partition.tree_size, 0U);
    }
    EXPECT_EQ(covered, std::vector<bool>(4, true));
    EXPECT_EQ(result.statistics.partitions.size(), options.strategy == Strategy::baseline ? 1U : 2U);
  }
}

TEST(Statistics, ExtractionTakesAsLongAsItsStages) {
  for (const ExtractOptions& options : test::with_and_without_cells()) {
    const StageSeconds seconds = extraction_of("m0", options).statistics.seconds;
    const double stages = seconds.segment + seconds.overlap + seconds.partition + seconds.classes + seconds.search +
                          seconds.merge + seconds.simplify;
    EXPECT_LE(stages, 1.001 * seconds.extraction);
    EXPECT_GE(seconds.total, seconds.extraction);
    EXPECT_EQ(seconds.read, 0.0);
    EXPECT_EQ(seconds.write, 0.0);
  }
}

}  // namespace
}  // namespace cloud2csg
