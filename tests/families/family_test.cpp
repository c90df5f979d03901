#include "bench/families/family.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"

namespace cloud2csg {
namespace {

/// As it is in the pipeline: the noise of the paper's clouds.
OverlapGraph overlaps(const Model& model) {
  return build_overlap_graph(model.primitives, {.tolerance = 0.01});
}

/// Of all families, some of several shapes.
std::vector<Model> some_models(std::size_t primitives) {
  std::vector<Model> models;
  for (const Family family : all_families()) {
    for (const std::uint64_t seed : {1U, 2U}) models.push_back(make_family(family, {primitives, 4, 0, 5, seed}));
  }
  for (const std::size_t size : {2U, 7U, 12U}) {
    models.push_back(make_family(Family::random, {.primitives = primitives, .clique_size = size}));
  }
  models.push_back(make_family(Family::random, {.primitives = primitives, .clique_size = 9, .least_clique_size = 2}));
  models.push_back(make_family(Family::nest, {.primitives = primitives, .levels = 8}));
  return models;
}

TEST(Family, HasTheNumberOfPrimitivesAskedForEachOnceInTheTree) {
  for (const std::size_t primitives : {1U, 2U, 3U, 5U, 14U, 40U, 101U}) {
    for (const Model& model : some_models(primitives)) {
      ASSERT_EQ(model.primitives.size(), primitives) << model.description;
      EXPECT_EQ(leaf_count(*model.tree), primitives) << model.description;
      EXPECT_EQ(primitives_of(*model.tree).size(), primitives) << model.description;
      EXPECT_EQ(model.tree->size(), 2 * primitives - 1) << model.description;
      for (const Primitive& primitive : model.primitives) validate(primitive);
    }
  }
}

TEST(Family, IsOneComponent) {
  for (const std::size_t primitives : {5U, 40U, 1000U}) {
    for (const Model& model : some_models(primitives)) {
      EXPECT_EQ(connected_components(overlaps(model)).size(), 1U) << model.description;
    }
  }
}

TEST(Family, DependsOnTheSeedAlone) {
  for (const Family family : all_families()) {
    const std::string one = to_json(make_family(family, {.primitives = 30, .seed = 7}));
    EXPECT_EQ(to_json(make_family(family, {.primitives = 30, .seed = 7})), one);
    EXPECT_NE(to_json(make_family(family, {.primitives = 30, .seed = 8})), one);
  }
}

/// Points are where the solid's surface is; of a primitive that shows, some lie on its own.
TEST(Family, ShowsAPartOfEveryPrimitive) {
  constexpr std::size_t k_points_each = 600;
  for (const Model& model : some_models(60)) {
    const PointCloud cloud = sample_surface(model, {.count = 60 * k_points_each});
    std::vector<int> owners(cloud.size(), 0);
    for (const Primitive& primitive : model.primitives) {
      std::size_t points = 0;
      const std::vector<double> distances = signed_distance(primitive, cloud.positions);
      for (std::size_t i = 0; i < distances.size(); ++i) {
        constexpr double k_on_surface = 1e-8;
        if (std::abs(distances[i]) > k_on_surface) continue;
        ++points;
        ++owners[i];
      }
      EXPECT_GE(points, 12U) << model.description << ", " << primitive.id;
    }
    // And no faces coincide: points of one lie on no other.
    EXPECT_EQ(std::ranges::count(owners, 1), static_cast<std::ptrdiff_t>(cloud.size())) << model.description;
  }
}

TEST(Family, ChainOverlapsTheNextOnly) {
  const OverlapGraph graph = overlaps(make_family(Family::chain, {.primitives = 300}));
  for (PrimitiveIndex p = 0; p < graph.size(); ++p) {
    std::vector<PrimitiveIndex> expected;
    if (p > 0) expected.push_back(p - 1);
    if (p + 1 < graph.size()) expected.push_back(p + 1);
    EXPECT_EQ(graph.neighbours[p], expected) << p;
  }
}

TEST(Family, GridOfTwentyIsTheModelOfThePaper) {
  const Model model = make_family(Family::grid, {.primitives = 20});
  EXPECT_EQ(clique_histogram(maximal_cliques(overlaps(model))), (std::vector<std::size_t>{0, 0, 0, 12}));
  for (const CsgNode node : model.tree->nodes()) {
    EXPECT_TRUE(node.is_leaf() || node.operation() == Operation::union_of);
  }
}

TEST(Family, RandomHasCliquesOfTheSizeAskedFor) {
  for (std::size_t size = 2; size <= 20; ++size) {
    const Model model = make_family(Family::random, {.primitives = 10 * size, .clique_size = size});
    const std::vector<std::size_t> histogram = clique_histogram(maximal_cliques(overlaps(model)));
    ASSERT_EQ(histogram.size(), size);
    // The bars that join the clusters make pairs.
    EXPECT_EQ(histogram[size - 1], size == 2 ? 19U : 10U) << size;
    EXPECT_EQ(std::accumulate(histogram.begin(), histogram.end(), std::size_t{0}), 19U) << size;
  }
}

TEST(Family, RandomMixesCliqueSizesOnDemand) {
  const Model model =
      make_family(Family::random, {.primitives = 200, .clique_size = 6, .least_clique_size = 3, .seed = 4});
  const std::vector<std::size_t> histogram = clique_histogram(maximal_cliques(overlaps(model)));
  ASSERT_EQ(histogram.size(), 6U);
  for (std::size_t size = 3; size <= 6; ++size) EXPECT_GT(histogram[size - 1], 3U) << size;
}

TEST(Family, NestIsADifferenceOfDifferences) {
  const Model model = make_family(Family::nest, {.primitives = 5, .levels = 5});
  EXPECT_EQ(to_text(*model.tree, model.primitives), "box_1 - (box_2 - (box_3 - (box_4 - box_5)))");
  // Each box lies wholly inside the one before.
  for (std::size_t level = 1; level < 5; ++level) {
    const PointCloud inner =
        sample_surface({.primitives = {model.primitives[level]}, .tree = CsgTree::leaf(0)}, {.count = 2000});
    for (const double distance : signed_distance(model.primitives[level - 1], inner.positions)) {
      ASSERT_LT(distance, -0.05) << level;
    }
  }
}

TEST(Family, PlateHasHolesAndHolesInHoles) {
  const Model model = make_family(Family::plate, {.primitives = 300});
  EXPECT_EQ(clique_histogram(maximal_cliques(overlaps(model))).size(), 4U);  // plate, hole, pin and its hole
  EXPECT_GT(std::ranges::count(model.tree->nodes(), Operation::difference, &CsgNode::operation), 30);
}

TEST(Family, PanelOverlapsAllOthersAndNoneElseDoes) {
  const OverlapGraph graph = overlaps(make_family(Family::panel, {.primitives = 60}));
  EXPECT_EQ(graph.neighbours.front().size(), 59U);
  for (std::size_t p = 1; p < 60; ++p) EXPECT_EQ(graph.neighbours[p], std::vector<PrimitiveIndex>{0}) << p;
}

TEST(Family, OfAName) {
  for (const Family family : all_families()) EXPECT_EQ(family_of(to_string(family)), family);
  EXPECT_THROW((void)family_of("chains"), Error);
}

TEST(Family, RefusesBadOptionsByName) {
  const auto refused = [](const FamilyOptions& options) {
    try {
      (void)make_family(Family::random, options);
    } catch (const Error& error) {
      return error.parts().where;
    }
    return std::string("none");
  };
  EXPECT_EQ(refused({.primitives = 0}), "primitives");
  EXPECT_EQ(refused({.clique_size = 1}), "clique_size");
  EXPECT_EQ(refused({.clique_size = 21}), "clique_size");
  EXPECT_EQ(refused({.clique_size = 4, .least_clique_size = 5}), "least_clique_size");
  EXPECT_EQ(refused({.levels = 0}), "levels");
}

}  // namespace
}  // namespace cloud2csg
