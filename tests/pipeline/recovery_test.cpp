#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "cloud2csg/extract.hpp"
#include "pipeline/strategies.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

PointCloud noisy_cloud(const Model& model, double noise, std::uint64_t seed, std::size_t count = 10'000) {
  return sample_surface(model, {.count = count, .noise = noise, .seed = seed});
}

using ModelAndSeed = std::tuple<const char*, std::uint64_t>;

class RecoversThePapersModels : public ::testing::TestWithParam<ModelAndSeed> {
 protected:
  void expect_recovered(double noise) {
    const auto& [name, seed] = GetParam();
    const Model model = test::paper_model(name);
    const PointCloud cloud = noisy_cloud(model, noise, seed);
    for (ExtractOptions options : test::with_and_without_cells()) {
      options.seed = seed;
      const Extraction result = extract_csg(cloud, model.primitives, options);
      EXPECT_GE(test::membership_iou(result.tree(), *model.tree, model.primitives), 0.999)
          << to_text(result.tree(), model.primitives);
      EXPECT_LE(4 * result.tree().size(), 5 * model.tree->size()) << to_text(result.tree(), model.primitives);
      EXPECT_TRUE(result.statistics.complete);
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Paper, RecoversThePapersModels,
                         ::testing::Combine(::testing::Values("m0", "m1", "m2", "m3"),
                                            ::testing::Values(std::uint64_t{1}, std::uint64_t{2})));

TEST_P(RecoversThePapersModels, FromAPerfectCloud) {
  expect_recovered(0);
}

TEST_P(RecoversThePapersModels, FromANoisyCloud) {
  expect_recovered(0.01);
}

struct ModelAndHistogram {
  const char* name;
  std::vector<std::size_t> cliques;
};

class CliqueHistogram : public ::testing::TestWithParam<ModelAndHistogram> {};

INSTANTIATE_TEST_SUITE_P(Paper, CliqueHistogram,
                         ::testing::Values(ModelAndHistogram{"m0", {0, 8, 4, 0, 1, 1}},
                                           ModelAndHistogram{"m1", {0, 0, 2}}, ModelAndHistogram{"m2", {0, 0, 0, 12}},
                                           ModelAndHistogram{"m3", {0, 7, 4, 1}}));

TEST_P(CliqueHistogram, IsThatOfThePaper) {
  const Model model = test::paper_model(GetParam().name);
  for (const double noise : {0.0, 0.01}) {
    const PointCloud cloud = noisy_cloud(model, noise, 3, 4000);
    for (ExtractOptions options : test::with_and_without_cells()) {
      options.search = paper_ga_options();
      const Extraction result = extract_csg(cloud, model.primitives, options);
      EXPECT_EQ(result.statistics.clique_histogram, GetParam().cliques) << noise;
    }
  }
}

TEST(ExtractCsg, UnitesComponentsThatDoNotTouch) {
  const PrimitiveSet primitives{
      test::placed("a", Box{{1, 1, 1}}, {0, 0, 0}), test::placed("b", Sphere{0.4}, {0.5, 0, 0}),
      test::placed("c", Cylinder{0.5, 1}, {5, 0, 0}), test::placed("d", Cylinder{0.2, 2}, {5, 0, 0}),
      test::placed("e", Sphere{0.3}, {0, 5, 0})};
  const CsgTree truth = parse_tree("(a - b) | (c - d) | e", primitives);
  const PointCloud cloud =
      sample_surface({.primitives = primitives, .tree = truth}, {.count = 6000, .noise = 0.003, .seed = 1});
  for (const ExtractOptions& options : test::all_strategies()) {
    const Extraction result = extract_csg(cloud, primitives, options);
    EXPECT_EQ(test::membership_iou(result.tree(), truth, primitives, 60), 1.0) << to_text(result.tree(), primitives);
    EXPECT_EQ(result.tree().size(), truth.size());
    EXPECT_EQ(result.statistics.components, options.strategy == Strategy::baseline ? 1U : 3U);
    EXPECT_EQ(result.statistics.clique_histogram, (std::vector<std::size_t>{1, 2}));
  }
}

TEST(ExtractCsg, SolvesASinglePrimitive) {
  const PrimitiveSet primitives{test::placed("ball", Sphere{1}, {0, 0, 0})};
  const PointCloud cloud =
      sample_surface({.primitives = primitives, .tree = CsgTree::leaf(0)}, {.count = 500, .noise = 0.01});
  for (const ExtractOptions& options : test::all_strategies()) {
    EXPECT_EQ(extract_csg(cloud, primitives, options).tree(), CsgTree::leaf(0));
  }
}

TEST(ExtractCsg, TakesASinglePoint) {
  const PrimitiveSet primitives{test::placed("ball", Sphere{1}, {0, 0, 0})};
  PointCloud cloud;
  cloud.positions.push_back({1, 0, 0});
  cloud.normals.push_back({1, 0, 0});
  for (const ExtractOptions& options : test::with_and_without_cells()) {
    const Extraction result = extract_csg(cloud, primitives, options);
    EXPECT_EQ(result.tree(), CsgTree::leaf(0));
    EXPECT_DOUBLE_EQ(result.statistics.fit.objective, 2.0);
  }
}

TEST(ExtractCsg, CutsWithHalfSpaces) {
  PrimitiveSet primitives{test::placed("ball", Sphere{1}, {0, 0, 0}), test::placed("below", HalfSpace{}, {0, 0, 0.3}),
                          test::placed("post", Cylinder{0.3, 4}, {0, 0, 0})};
  const CsgTree truth = parse_tree("(ball & below) - post", primitives);
  const PointCloud cloud =
      sample_surface({.primitives = primitives, .tree = truth}, {.count = 5000, .noise = 0.004, .seed = 4});
  for (const ExtractOptions& options : test::all_strategies()) {
    const Extraction result = extract_csg(cloud, primitives, options);
    EXPECT_EQ(test::membership_iou(result.tree(), truth, primitives), 1.0) << to_text(result.tree(), primitives);
  }
}

PrimitiveSet scaled(PrimitiveSet primitives, double factor) {
  for (Primitive& primitive : primitives) {
    primitive.pose.position *= factor;
    if (auto* box = std::get_if<Box>(&primitive.shape)) box->size *= factor;
    if (auto* sphere = std::get_if<Sphere>(&primitive.shape)) sphere->radius *= factor;
    if (auto* cylinder = std::get_if<Cylinder>(&primitive.shape)) {
      cylinder->radius *= factor;
      cylinder->height *= factor;
    }
  }
  return primitives;
}

PointCloud scaled(PointCloud cloud, double factor) {
  for (std::vector<double>* axis : {&cloud.positions.x, &cloud.positions.y, &cloud.positions.z}) {
    for (double& coordinate : *axis) coordinate *= factor;
  }
  return cloud;
}

TEST(ExtractCsg, GivesTheSameTreeAtEveryScale) {
  for (const char* name : {"m0", "m2"}) {
    const Model model = test::paper_model(name);
    const PointCloud cloud = noisy_cloud(model, 0.005, 7, 6000);
    for (const ExtractOptions& options : test::with_and_without_cells()) {
      const Extraction expected = extract_csg(cloud, model.primitives, options);
      for (const double factor : {0.01, 1000.0}) {
        const Extraction result = extract_csg(scaled(cloud, factor), scaled(model.primitives, factor), options);
        EXPECT_EQ(result.tree(), expected.tree()) << name << ' ' << factor;
        EXPECT_NEAR(result.statistics.noise, factor * expected.statistics.noise, 1e-6 * factor);
      }
    }
  }
}

/// Thousands of candidates that are not there must not drown what else is to be said.
TEST(ExtractCsg, NamesOnlyTheFirstOfManyPrimitivesThatNoPointSupports) {
  PrimitiveSet primitives{test::placed("a", Box{{1, 1, 1}}, {0, 0, 0})};
  const PointCloud cloud =
      sample_surface({.primitives = primitives, .tree = CsgTree::leaf(0)}, {.count = 1000, .noise = 0.002, .seed = 1});
  for (int k = 0; k < 500; ++k) {
    std::string id("far");
    id += std::to_string(k);
    primitives.push_back(test::placed(id, Sphere{0.2}, {9.0 + k, 9, 9}));
  }
  for (const ExtractOptions& options : test::with_and_without_cells()) {
    const Extraction result = extract_csg(cloud, primitives, options);
    EXPECT_EQ(result.tree(), CsgTree::leaf(0));
    const std::vector<std::string>& warnings = result.statistics.warnings;
    ASSERT_EQ(warnings.size(), 11U);
    EXPECT_NE(warnings.front().find("'far0'"), std::string::npos);
    EXPECT_NE(warnings.back().find("490 more"), std::string::npos);
  }
}

TEST(ExtractCsg, DropsPrimitivesThatNoPointSupports) {
  PrimitiveSet primitives{test::placed("nowhere", Sphere{0.2}, {9, 9, 9}), test::placed("a", Box{{1, 1, 1}}, {0, 0, 0}),
                          test::placed("hidden", Sphere{0.2}, {0, 0, 0}), test::placed("b", Sphere{0.4}, {0.5, 0, 0})};
  const CsgTree truth = parse_tree("a - b", primitives);
  const PointCloud cloud =
      sample_surface({.primitives = primitives, .tree = truth}, {.count = 3000, .noise = 0.002, .seed = 1});
  for (const ExtractOptions& options : test::all_strategies()) {
    const Extraction result = extract_csg(cloud, primitives, options);
    EXPECT_EQ(result.tree(), truth);
    EXPECT_EQ(result.statistics.primitives, 4U);
    ASSERT_EQ(result.statistics.warnings.size(), 2U);
    EXPECT_NE(result.statistics.warnings[0].find("'nowhere'"), std::string::npos);
    EXPECT_NE(result.statistics.warnings[1].find("'hidden'"), std::string::npos);
    for (const PartitionStatistics& partition : result.statistics.partitions) {
      EXPECT_EQ(partition.primitives, (std::vector<PrimitiveIndex>{1, 3}));
    }
  }
}

}  // namespace
}  // namespace cloud2csg
