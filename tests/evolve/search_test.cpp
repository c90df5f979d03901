#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <stop_token>

#include "cloud2csg/advanced/evolve.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/sample.hpp"
#include "paper/evolve/genetic_algorithm.hpp"
#include "support/known_solids.hpp"
#include "support/scene.hpp"
#include "tree/random_trees.hpp"

namespace cloud2csg {
namespace {

/// Options of a search that takes a moment only.
GaOptions short_search(std::uint64_t seed = 1) {
  GaOptions options;
  options.population = 60;
  options.idle_generations = 6;
  options.generation_limit = 30;
  options.seed = seed;
  return options;
}

RankClasses random_table(std::size_t primitives, std::uint64_t seed) {
  RandomStream random(seed);
  return test::whole_table(test::random_scene(primitives, 600, random));
}

bool is_valid_over(const CsgTree& tree, std::size_t primitives) {
  for (const PrimitiveIndex p : primitives_of(tree)) {
    if (p >= primitives) return false;
  }
  return test::is_well_formed(tree) && !primitives_of(tree).empty();
}

void expect_consistent(const Evolution& evolution, const RankClasses& table) {
  RankScratch scratch;
  EXPECT_TRUE(is_valid_over(evolution.tree, table.primitive_count()));
  EXPECT_EQ(evolution.score, table.score(evolution.tree, scratch));
  EXPECT_EQ(evolution.geometry, table.geometry(evolution.tree, scratch));
  EXPECT_GT(evolution.evaluations, 0U);
}

TEST(PaperGaOptions, AreThoseOfThePaper) {
  const GaOptions paper = paper_ga_options();
  EXPECT_EQ(paper.population, 150);
  EXPECT_EQ(paper.elites, 2);
  EXPECT_EQ(paper.tournament, 2);
  EXPECT_EQ(paper.crossover_rate, 0.3);
  EXPECT_EQ(paper.mutation_rate, 0.3);
  EXPECT_EQ(paper.new_tree_rate, 0.5);
  EXPECT_EQ(paper.idle_generations, 10);
  EXPECT_FALSE(paper.height_limit.has_value());
  EXPECT_EQ(paper.listing_limit, 2U);
  EXPECT_EQ(paper.trust, 0.0);
  EXPECT_EQ(paper.restarts, 0);
  EXPECT_FALSE(paper.seeds);
  EXPECT_FALSE(paper.polish);
}

TEST(DefaultHeightLimit, IsTheFormulaOfThePaperAndAtLeastOne) {
  EXPECT_EQ(default_height_limit(1), 1);
  EXPECT_EQ(default_height_limit(2), 1);    // sqrt(pi) = 1.77
  EXPECT_EQ(default_height_limit(6), 6);    // sqrt(pi / 2 * 30) = 6.86
  EXPECT_EQ(default_height_limit(20), 24);  // sqrt(pi / 2 * 380) = 24.4
}

TEST(GeneticAlgorithm, KeepsItsHeightLimit) {
  const RankClasses table = random_table(6, 3);
  for (int limit = 1; limit <= 4; ++limit) {
    GaOptions options = short_search();
    options.height_limit = limit;
    const Evolution evolution = run_genetic_algorithm(objective_on(table), {}, options, 0, {});
    expect_consistent(evolution, table);
    EXPECT_LE(depth(evolution.tree), static_cast<std::size_t>(limit));
  }
}

TEST(GeneticAlgorithm, StopsAtTheGenerationLimitAndAfterIdleGenerations) {
  const RankClasses table = random_table(6, 3);
  GaOptions options = short_search();
  options.generation_limit = 3;
  options.idle_generations = 100;
  EXPECT_EQ(run_genetic_algorithm(objective_on(table), {}, options, 0, {}).generations, 3U);
  options.generation_limit = 1000;
  options.idle_generations = 4;
  const Evolution idle = run_genetic_algorithm(objective_on(table), {}, options, 0, {});
  EXPECT_GE(idle.generations, 4U);
  EXPECT_LT(idle.generations, 1000U);
  EXPECT_TRUE(idle.complete);
}

TEST(GeneticAlgorithm, NeverLosesTheBestOfItsSeeds) {
  RandomStream random(21);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const RankClasses table = random_table(5, seed);
    const std::vector<CsgTree> seeds = test::random_formulas(5, 5, random);
    const Evolution evolution = run_genetic_algorithm(objective_on(table), seeds, short_search(seed), 0, {});
    RankScratch scratch;
    for (const CsgTree& tree : seeds) EXPECT_GE(evolution.score, table.score(tree, scratch));
  }
}

TEST(GeneticAlgorithm, CountsItsEvaluations) {
  const RankClasses table = random_table(4, 5);
  const GaOptions options = short_search();
  for (const int threads : {1, 4}) {
    const Evolution evolution = run_genetic_algorithm(objective_on(table), {}, options, 0, {.threads = threads});
    EXPECT_EQ(evolution.evaluations, 60 + evolution.generations * 58);
  }
}

TEST(GeneticAlgorithm, TakesOddPopulationsAndNoElites) {
  const RankClasses table = random_table(4, 6);
  for (const int population : {2, 3, 7}) {
    for (const int elites : {0, 1}) {
      GaOptions options = short_search();
      options.population = population;
      options.elites = elites;
      expect_consistent(run_genetic_algorithm(objective_on(table), {}, options, 0, {}), table);
    }
  }
}

TEST(EvolveTree, GivesTheSameTreeForTheSameSeedAndAnyThreads) {
  for (const std::size_t primitives : {3U, 5U, 7U, 130U}) {
    const RankClasses table = random_table(primitives, primitives);
    GaOptions options = short_search(9);
    if (primitives > 100) options.seeds = options.polish = false;
    const Evolution expected = evolve_tree(table, options, 4, {});
    expect_consistent(expected, table);
    for (const int threads : {1, 2, 8}) {
      const Evolution evolution = evolve_tree(table, options, 4, {.threads = threads});
      EXPECT_EQ(evolution.tree, expected.tree);
      EXPECT_EQ(evolution.score, expected.score);
      EXPECT_EQ(evolution.generations, expected.generations);
      EXPECT_EQ(evolution.evaluations, expected.evaluations);
    }
  }
}

TEST(EvolveTree, HasARandomStreamForEachSeedAndItem) {
  const RankClasses table = random_table(8, 12);
  GaOptions options = paper_ga_options();
  options.generation_limit = 1;
  const auto tree = [&](std::uint64_t seed, std::uint64_t item) {
    options.seed = seed;
    return run_genetic_algorithm(objective_on(table), {}, options, item, {}).tree;
  };
  EXPECT_EQ(tree(1, 1), tree(1, 1));
  std::size_t different = 0;
  for (std::uint64_t k = 2; k < 10; ++k) {
    different += tree(k, 1) != tree(1, 1) ? 1 : 0;
    different += tree(1, k) != tree(1, 1) ? 1 : 0;
  }
  EXPECT_GT(different, 8U);
}

TEST(EvolveTree, StopsOnATriggeredTokenWithATree) {
  std::stop_source stop;
  stop.request_stop();
  const RankClasses table = random_table(7, 2);
  for (const int threads : {1, 2}) {
    const RunContext run{.stop = stop.get_token(), .on_progress = {}, .threads = threads};
    const Evolution evolution = evolve_tree(table, {}, 0, run);
    expect_consistent(evolution, table);
    EXPECT_FALSE(evolution.complete);
    EXPECT_EQ(evolution.generations, 0U);
    const Evolution continued = evolve_tree_from(table, CsgTree::leaf(3), {}, 0, run);
    expect_consistent(continued, table);
    EXPECT_FALSE(continued.complete);
  }
}

TEST(EvolveTree, WorksWithTheOptionsOfThePaper) {
  for (const std::size_t primitives : {1U, 2U, 3U, 6U}) {
    const RankClasses table = random_table(primitives, 30 + primitives);
    const Evolution evolution = evolve_tree(table, paper_ga_options(), 0, {});
    expect_consistent(evolution, table);
    EXPECT_EQ(evolution.generations == 0, primitives <= 2) << "one and two primitives are listed";
  }
}

TEST(EvolveTreeFrom, IsNotWorseThanItsStart) {
  RandomStream random(4);
  const RankClasses table = random_table(6, 4);
  RankScratch scratch;
  for (const CsgTree& start : test::random_formulas(6, 8, random)) {
    const Evolution evolution = evolve_tree_from(table, start, short_search(), 0, {});
    expect_consistent(evolution, table);
    EXPECT_GE(evolution.score, table.score(start, scratch));
  }
}

TEST(EvolveTreeFrom, TakesTheEmptySolidAndAllOfSpaceAsAStart) {
  const RankClasses table = random_table(6, 4);
  for (const CsgTree& start : {CsgTree::empty(), CsgTree::full()}) {
    expect_consistent(evolve_tree_from(table, start, short_search(), 0, {}), table);
  }
}

TEST(LocalSearch, EndsWhereNoSmallChangeHelps) {
  RandomStream random(6);
  const RankClasses table = random_table(5, 6);
  RankScratch scratch;
  for (const CsgTree& start : test::random_formulas(5, 10, random)) {
    const Evolution found = local_search(table, start);
    expect_consistent(found, table);
    EXPECT_TRUE(found.complete);
    EXPECT_GE(found.score, table.score(start, scratch));
    EXPECT_EQ(local_search(table, found.tree).tree, found.tree);
  }
}

TEST(LocalSearch, ShrinksOnlyWhenToldTo) {
  RandomStream random(7);
  const RankClasses table = random_table(5, 7);
  for (const CsgTree& start : test::random_formulas(5, 20, random)) {
    const Evolution found = local_search(table, start, {.shrink_only = true});
    EXPECT_LE(found.tree.size(), start.size());
    expect_consistent(found, table);
  }
}

TEST(LocalSearch, KeepsItsEvaluationLimit) {
  const RankClasses table = random_table(6, 8);
  const Evolution found = local_search(table, CsgTree::leaf(0), {.evaluation_limit = 25});
  EXPECT_LE(found.evaluations, 25U);
  expect_consistent(found, table);
}

TEST(LocalSearch, LeavesConstantsForALeaf) {
  const RankClasses table = random_table(4, 9);
  expect_consistent(local_search(table, CsgTree::empty()), table);
  EXPECT_EQ(local_search(table, CsgTree::full(), {.shrink_only = true}).tree, CsgTree::full());
}

/// A sphere's surface seen from both sides: the points within it have normals that look inwards, so that a - a, which
/// is no solid, fits every point.
TEST(EvolveTree, GivesASolidWhereOnlyAnEmptyFormulaFits) {
  const PrimitiveSet primitives{test::placed("ball", Sphere{1}, {0, 0, 0})};
  RandomStream random(3);
  PointCloud cloud;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d direction = test::random_direction(random);
    const double offset = 0.002 * (2 * (i % 2) - 1);
    cloud.positions.push_back((1 + offset) * direction);
    cloud.normals.push_back(offset > 0 ? direction : Eigen::Vector3d(-direction));
  }
  const RankClasses table = test::whole_table({.primitives = primitives, .cloud = cloud});
  const Evolution evolution = evolve_tree(table, {}, 0, {});
  EXPECT_FALSE(primitives_of(simplify(evolution.tree)).empty());
  expect_consistent(evolution, table);
}

/// What a search that is run anew for lack of trust does, and the same without.
struct Restarted {
  Evolution with, without;
};

Restarted restarted(const GaOptions& options, std::uint64_t seed) {
  const RankClasses table = random_table(6, seed);
  GaOptions once = options;
  once.restarts = 0;
  return {evolve_tree(table, options, 0), evolve_tree(table, once, 0)};
}

TEST(Restarts, TakePlaceWhileTheTreeIsNotBelieved) {
  GaOptions options = short_search();
  options.trust = 1;  // of points drawn at random no tree explains all
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto [with, without] = restarted(options, seed);
    EXPECT_GT(with.generations, without.generations);
    EXPECT_GE(with.score, without.score);
  }
}

TEST(Restarts, DoNotTakePlaceWhenTheTreeIsBelievedOrTheBudgetSpent) {
  GaOptions believing = short_search();
  believing.trust = 0;
  GaOptions poor = short_search();
  poor.trust = 1;
  poor.restart_budget = 1;
  for (const GaOptions& options : {believing, poor}) {
    const auto [with, without] = restarted(options, 3);
    EXPECT_EQ(with.tree, without.tree);
    EXPECT_EQ(with.evaluations, without.evaluations);
  }
}

/// Overlapping solids, a formula over them that uses each once, and a cloud of what it is.
struct Puzzle {
  PrimitiveSet primitives;
  CsgTree truth;
};

Puzzle random_puzzle(std::size_t count, RandomStream& random) {
  Puzzle puzzle;
  std::vector<CsgTree> parts;
  for (std::size_t p = 0; p < count; ++p) {
    const Eigen::Vector3d position = test::random_within(0.4, random);
    const double size = random.uniform(0.35, 0.6);
    const Shape shape = p % 3 == 0   ? Shape(Box{Eigen::Vector3d(1.6, 1.3, 1.1) * size})
                        : p % 3 == 1 ? Shape(Sphere{.radius = size})
                                     : Shape(Cylinder{.radius = 0.6 * size, .height = 3 * size});
    puzzle.primitives.push_back(test::placed("p", shape, position));
    puzzle.primitives.back().id += std::to_string(p);
    const double angle = random.uniform(0, 3);
    puzzle.primitives.back().pose.orientation = Eigen::AngleAxisd(angle, test::random_direction(random));
    parts.push_back(CsgTree::leaf(static_cast<PrimitiveIndex>(p)));
  }
  while (parts.size() > 1) {
    const std::size_t at = random.below(parts.size() - 1);
    const std::uint32_t operation = random.below(3);
    parts[at] = operation == 0   ? unite(parts[at], parts[at + 1])
                : operation == 1 ? intersect(parts[at], parts[at + 1])
                                 : subtract(parts[at], parts[at + 1]);
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(at + 1));
  }
  puzzle.truth = parts.front();
  return puzzle;
}

bool has_volume(const Puzzle& puzzle) {
  const Points points = test::lattice(test::bounds_of_all(puzzle.primitives), 25);
  const std::vector<double> values = implicit_value(puzzle.truth, puzzle.primitives, points);
  return std::ranges::count_if(values, [](double value) { return value < 0; }) > 100;
}

TEST(EvolveTree, RecoversRandomFormulas) {
  std::size_t tried = 0;
  for (std::uint64_t seed = 0; tried < 30; ++seed) {
    RandomStream random(seed);
    const std::size_t count = 1 + seed % 5;
    const Puzzle puzzle = random_puzzle(count, random);
    if (!has_volume(puzzle)) continue;
    ++tried;
    const PointCloud cloud = sample_surface({.primitives = puzzle.primitives, .tree = puzzle.truth},
                                            {.count = 4000, .noise = 0.001, .seed = seed});
    Clique all(count);
    std::iota(all.begin(), all.end(), 0U);
    const CsgTree tree = evolve_tree(cloud, puzzle.primitives, all, {.seed = seed});
    EXPECT_GE(test::membership_iou(tree, puzzle.truth, puzzle.primitives), 0.995)
        << seed << ": " << to_text(tree, puzzle.primitives) << " for " << to_text(puzzle.truth, puzzle.primitives);
    EXPECT_LE(static_cast<double>(tree.size()), 1.25 * static_cast<double>(puzzle.truth.size()))
        << seed << ": " << to_text(tree, puzzle.primitives) << " for " << to_text(puzzle.truth, puzzle.primitives);
  }
}

TEST(EvolveTree, RenamesThePrimitivesOfAClique) {
  const PrimitiveSet primitives{
      test::placed("far", Sphere{0.5}, {5, 0, 0}), test::placed("a", Box{{1, 1, 1}}, {0, 0, 0}),
      test::placed("other", Sphere{0.5}, {0, 5, 0}), test::placed("b", Sphere{0.4}, {0.5, 0, 0})};
  const CsgTree truth = subtract(CsgTree::leaf(1), CsgTree::leaf(3));
  const PointCloud cloud = sample_surface({.primitives = primitives, .tree = truth}, {.count = 2000, .seed = 1});
  EXPECT_EQ(evolve_tree(cloud, primitives, Clique{1, 3}), truth);
}

}  // namespace
}  // namespace cloud2csg
