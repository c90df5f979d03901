#include "paper/evolve/listing.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "cloud2csg/advanced/evolve.hpp"
#include "cloud2csg/sample.hpp"
#include "support/known_solids.hpp"
#include "support/scene.hpp"

namespace cloud2csg {
namespace {

/// All trees that use exactly the primitives of a set once, complements anywhere. A bit of `subset` is a primitive.
std::vector<CsgTree> read_once_trees(std::uint32_t subset) {
  std::vector<CsgTree> trees;
  if (std::has_single_bit(subset)) {
    trees.push_back(CsgTree::leaf(static_cast<PrimitiveIndex>(std::countr_zero(subset))));
  }
  for (std::uint32_t part = (subset - 1) & subset; part > 0; part = (part - 1) & subset) {
    for (const CsgTree& a : read_once_trees(part)) {
      for (const CsgTree& b : read_once_trees(subset ^ part)) {
        trees.push_back(unite(a, b));
        trees.push_back(intersect(a, b));
        trees.push_back(subtract(a, b));
      }
    }
  }
  const std::size_t plain = trees.size();
  for (std::size_t i = 0; i < plain; ++i) trees.push_back(complement(trees[i]));
  return trees;
}

double best_score_by_brute_force(const RankClasses& table) {
  RankScratch scratch;
  double best = -1e300;
  for (std::uint32_t subset = 1; subset < 1U << table.primitive_count(); ++subset) {
    for (const CsgTree& tree : read_once_trees(subset)) best = std::max(best, table.score(tree, scratch));
  }
  return best;
}

RC_GTEST_PROP(ListTrees, FindsTheBestOfAllReadOnceTrees, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(3);
  const test::Scene scene = test::random_scene(primitives, 1 + random.below(200), random);
  const RankClasses table = test::whole_table(scene, test::all_weights()[random.below(3)]);
  const Listing listing = list_trees(table);
  RankScratch scratch;
  RC_ASSERT(listing.best.score == table.score(listing.best.tree, scratch));
  RC_ASSERT(listing.best.score == best_score_by_brute_force(table));
  RC_ASSERT(leaf_count(listing.best.tree) == primitives_of(listing.best.tree).size());
}

TEST(ListTrees, GivesATreeWhenStopped) {
  RandomStream random(4);
  const RankClasses table = test::whole_table(test::random_scene(4, 300, random));
  std::stop_source stop;
  stop.request_stop();
  const Listing listing = list_trees(table, stop.get_token());
  RankScratch scratch;
  EXPECT_FALSE(listing.complete);
  EXPECT_EQ(listing.best.score, table.score(listing.best.tree, scratch));
  EXPECT_TRUE(list_trees(table).complete);
}

/// Solids that all overlap, none inside another, and points enough to tell all cells apart: nothing is listed twice, so
/// that the count of evaluations (each tree and its complement) is the number of read-once formulas.
TEST(ListTrees, ListsAsManyTreesAsThereAre) {
  PrimitiveSet primitives;
  RandomStream random(2);
  for (int p = 0; p < 5; ++p) {
    primitives.push_back(test::placed("p", Sphere{1.0}, 0.3 * test::random_direction(random)));
  }
  const test::Scene scene{.primitives = primitives, .cloud = test::random_cloud(primitives, 20'000, random)};
  constexpr std::array<std::size_t, 6> k_using_all{0, 1, 4, 32, 416, 7552};
  for (PrimitiveIndex count = 1; count <= 5; ++count) {
    std::vector<PrimitiveIndex> some(count);
    std::iota(some.begin(), some.end(), 0U);
    const PointPass pass = test::pass_over(scene, {{.primitives = some, .all_points = true}});
    std::size_t expected = 0;
    std::size_t choices = 1;  // count over k
    for (std::size_t k = 1; k <= count; ++k) {
      choices = choices * (count - k + 1) / k;
      expected += choices * k_using_all[k];
    }
    EXPECT_EQ(list_trees(pass.tables.front()).evaluations, 2 * expected) << count;
  }
}

TEST(ListTrees, IsAsGoodAsLocalSearchOnReadOnceSolids) {
  const PrimitiveSet primitives{
      test::placed("a", Box{{1, 1, 1}}, {0, 0, 0}), test::placed("b", Sphere{0.6}, {0.4, 0, 0.3}),
      test::placed("c", Cylinder{0.2, 2}, {0.1, 0.1, 0}), test::placed("d", Box{{0.5, 2, 0.3}}, {0, 0, 0.4})};
  for (const char* formula : {"a - b", "(a | b) - c", "(a & b) - d", "((a | b) - c) | d", "(a - c) & (b | d)"}) {
    const CsgTree truth = parse_tree(formula, primitives);
    const test::Scene scene{
        .primitives = primitives,
        .cloud = sample_surface({.primitives = primitives, .tree = truth}, {.count = 3000, .noise = 0.003, .seed = 2})};
    const RankClasses table = test::whole_table(scene);
    const Listing listing = list_trees(table);
    RankScratch scratch;
    EXPECT_GE(listing.best.score, table.score(truth, scratch)) << formula;
    for (const CsgTree& start : {truth, parse_tree("a | b | c | d", primitives), CsgTree::leaf(2)}) {
      EXPECT_GE(listing.best.score, local_search(table, start).score) << formula;
    }
  }
}

}  // namespace
}  // namespace cloud2csg
