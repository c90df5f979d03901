#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "bench/families/family.hpp"
#include "cells/labelled.hpp"
#include "cloud2csg/advanced/cells.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/base/random.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

Cell random_cell(std::size_t primitives, RandomStream& random) {
  Cell cell;
  for (PrimitiveIndex p = 0; p < primitives; ++p) {
    if (random.chance(0.4)) cell.push_back(p);
  }
  return cell;
}

class PaperModels : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Models, PaperModels, ::testing::Values("m0", "m1", "m2", "m3"));

TEST_P(PaperModels, AreSolvedToTheTruth) {
  const Model model = test::paper_model(GetParam());
  const Labelled labelled = label(sample_surface(model, {.count = 5000, .noise = 0.005, .seed = 2}), model.primitives);
  const std::optional<CellSolution> solution = labelled.solve();
  ASSERT_TRUE(solution.has_value());
  for (const Cell& cell : labelled.complex.cells) {
    EXPECT_EQ(is_in(solution->tree, cell, model.primitives.size()), is_in(*model.tree, cell, model.primitives.size()));
  }
  EXPECT_EQ(solution->tree.size(), simplify(*model.tree).size()) << to_text(solution->tree, model.primitives);
  EXPECT_TRUE(solution->is_minimal());
  EXPECT_EQ(simplify(solution->tree), solution->tree);
  EXPECT_LT(solution->cost, 0.02 * labelled.labels.points);
  EXPECT_GE(solution->cost, labelled.labels.cost);
  const std::optional<CellSolution> again = labelled.solve();
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->tree, solution->tree);
  EXPECT_EQ(again->cost, solution->cost);
  EXPECT_EQ(again->least_evidence, solution->least_evidence);
}

/// A primitive in each of `leaves`, one operation after the other.
CsgTree random_chain(const std::vector<PrimitiveIndex>& leaves, RandomStream& random) {
  CsgTree tree = CsgTree::leaf(leaves.front());
  for (std::size_t i = 1; i < leaves.size(); ++i) {
    const CsgTree next = CsgTree::leaf(leaves[i]);
    switch (random.below(4)) {
      case 0:
        tree = unite(tree, next);
        break;
      case 1:
        tree = intersect(tree, next);
        break;
      case 2:
        tree = subtract(tree, next);
        break;
      default:
        tree = subtract(next, tree);
    }
  }
  return tree;
}

std::vector<PrimitiveIndex> random_leaves(std::size_t primitives, std::size_t count, RandomStream& random) {
  std::vector<PrimitiveIndex> leaves(count);
  for (PrimitiveIndex& leaf : leaves) leaf = random.below(primitives);
  return leaves;
}

/// Some cells of a random formula, some of them open.
RC_GTEST_PROP(SolveCells, HasTheLabelsOfAllSureCells, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(8);
  const CsgTree truth = random_chain(random_leaves(primitives, 1 + random.below(primitives + 3), random), random);
  std::set<Cell> cells{Cell{}};
  for (std::size_t i = random.below(60); i > 0; --i) cells.insert(random_cell(primitives, random));
  Labelled labelled = labelled_by(truth, cells, primitives);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!random.chance(0.2)) continue;
    labelled.labels.evidence[c] = 0;
    if (c > 0) labelled.labels.is_in[c] = random.chance(0.5);
  }
  const std::optional<CellSolution> solution = labelled.solve();
  RC_ASSERT(solution.has_value());
  RC_ASSERT(has_labels(solution->tree, labelled, solution->least_evidence));
  RC_ASSERT(solution->least_leaves <= leaf_count(solution->tree));
  RC_ASSERT(solution->least_leaves <= leaf_count(truth));
  RC_ASSERT(simplify(solution->tree) == solution->tree);
}

/// All cells that there may be.
std::set<Cell> all_cells(std::size_t primitives) {
  std::set<Cell> cells;
  for (std::size_t code = 0; code < std::size_t{1} << primitives; ++code) {
    Cell cell;
    for (PrimitiveIndex p = 0; p < primitives; ++p) {
      if ((code >> p & 1U) != 0) cell.push_back(p);
    }
    cells.insert(cell);
  }
  return cells;
}

RC_GTEST_PROP(SolveCells, IsNoLargerThanTheTruthWhereItIsMinimal, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(5);
  const CsgTree truth = random_chain(random_leaves(primitives, 1 + random.below(primitives + 3), random), random);
  const std::optional<CellSolution> solution = labelled_by(truth, all_cells(primitives), primitives).solve();
  RC_ASSERT(solution.has_value());
  RC_ASSERT(solution->least_leaves <= leaf_count(truth));
  RC_ASSERT(!solution->is_minimal() || leaf_count(solution->tree) <= leaf_count(truth));
  RC_ASSERT(solution->open_cells.empty());
}

/// Twelve solids that all meet: what few points say of the cells between them takes some of them several times.
Labelled dense_cluster(std::uint64_t seed) {
  const Model model = make_family(Family::random, {.primitives = 12, .clique_size = 12, .seed = seed});
  const PointCloud cloud = sample_surface(model, {.count = 1500, .noise = k_noise, .seed = seed});
  return label(cloud, model.primitives);
}

TEST(SolveCells, ClimbsWhereADecompositionIsNotMinimal) {
  const CellSolveOptions options;
  CellSolveOptions without = options;
  without.climb.work_limit = 0;
  std::size_t better = 0;
  std::size_t kept = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const Labelled labelled = dense_cluster(seed);
    const std::optional<CellSolution> climbed = labelled.solve(options);
    const std::optional<CellSolution> start = labelled.solve(without);
    ASSERT_TRUE(climbed && start);
    const auto total = [&](const CellSolution& of) {
      return of.cost + options.leaf_cost * static_cast<double>(leaf_count(of.tree));
    };
    EXPECT_LE(total(*climbed), total(*start)) << seed;
    EXPECT_TRUE(has_labels(climbed->tree, labelled, options.least_evidence.front())) << seed;
    EXPECT_LE(climbed->least_leaves.value_or(0), leaf_count(climbed->tree)) << seed;
    if (climbed->least_leaves) {
      EXPECT_TRUE(has_labels(climbed->tree, labelled, climbed->least_evidence)) << seed;
    }
    if (start->is_minimal() && start->cost < labelled.labels.cost + options.leaf_cost) {
      EXPECT_EQ(climbed->tree, start->tree) << seed;
      ++kept;
    }
    better += total(*climbed) < total(*start) ? 1 : 0;
  }
  RecordProperty("better", static_cast<int>(better));
  EXPECT_GT(better, 0U);
  EXPECT_GT(kept, 0U);
}

RC_GTEST_PROP(SolveCells, FindsReadOnceFormulas, (std::uint64_t seed)) {
  RandomStream random(seed);
  std::vector<PrimitiveIndex> leaves(1 + random.below(7));
  std::iota(leaves.begin(), leaves.end(), 0U);
  const CsgTree truth = random_chain(leaves, random);
  const std::optional<CellSolution> solution = labelled_by(truth, all_cells(leaves.size()), leaves.size()).solve();
  RC_ASSERT(solution.has_value());
  RC_ASSERT(leaf_count(solution->tree) == leaves.size());
  RC_ASSERT(solution->is_minimal());
}

/// A sphere within the box, and one across its face, of which nothing is seen.
TEST(SolveCells, LeavesOutPrimitivesThatAreNotThere) {
  const PrimitiveSet primitives{
      test::placed("inner", Sphere{0.4}, {-0.4, 0.3, 0.2}), test::placed("a", Box{{2, 2, 2}}, {0, 0, 0}),
      test::placed("across", Sphere{0.5}, {-1, 0, 0}), test::placed("b", Cylinder{0.3, 3}, {0.5, -0.5, 0})};
  const PointCloud cloud = sample_surface({.primitives = primitives, .tree = parse_tree("a - b", primitives)},
                                          {.count = 5000, .noise = k_noise, .seed = 2});
  const std::optional<CellSolution> solution = label(cloud, primitives).solve();
  ASSERT_TRUE(solution.has_value());
  EXPECT_EQ(to_text(solution->tree, primitives), "a - b");
  EXPECT_TRUE(solution->is_minimal());
}

/// A detection that finds a solid again and again, nearly where it is.
TEST(SolveCells, UsesOneOfSeveralCopies) {
  PrimitiveSet primitives{test::placed("a", Box{{2, 2, 2}}, {0, 0, 0}), test::placed("b", Sphere{0.7}, {1, 0, 0})};
  const PointCloud cloud = sample_surface({.primitives = primitives, .tree = parse_tree("a - b", primitives)},
                                          {.count = 5000, .noise = k_noise, .seed = 2});
  primitives.push_back(test::placed("a2", Box{{2, 2, 2}}, {0, 0, 0}));
  primitives.push_back(test::placed("b2", Sphere{0.702}, {1, 0.001, 0}));
  const std::optional<CellSolution> solution = label(cloud, primitives).solve();
  ASSERT_TRUE(solution.has_value());
  EXPECT_EQ(leaf_count(solution->tree), 2U);
  EXPECT_GE(test::membership_iou(solution->tree, parse_tree("a - b", primitives), primitives), 0.99);
}

/// Of hundreds of primitives and some hundred points each.
TEST(SolveCells, SolvesLargeModels) {
  for (const auto& [family, primitives] : {std::pair(Family::grid, 400U), std::pair(Family::panel, 200U)}) {
    const Model model = make_family(family, {.primitives = primitives});
    const PointCloud cloud = sample_surface(model, {.count = 40'000, .noise = k_noise, .seed = 1});
    const std::optional<CellSolution> solution = label(cloud, model.primitives).solve();
    ASSERT_TRUE(solution.has_value());
    EXPECT_EQ(leaf_count(solution->tree), primitives) << to_string(family);
    EXPECT_TRUE(solution->is_minimal());
    EXPECT_GE(test::membership_iou(solution->tree, *model.tree, model.primitives, 20), 0.9999) << to_string(family);
  }
}

/// What two neighbours in a row share is in, and nothing else: no primitive can be split off.
Labelled row_of_intersections(std::size_t primitives, const std::set<std::size_t>& gaps = {}) {
  std::set<Cell> cells{Cell{}};
  std::vector<CsgTree> parts;
  for (PrimitiveIndex p = 0; p < primitives; ++p) {
    cells.insert({p});
    if (p + 1 == primitives || gaps.contains(p)) continue;
    cells.insert({p, p + 1});
    parts.push_back(intersect(CsgTree::leaf(p), CsgTree::leaf(p + 1)));
  }
  return labelled_by(unite_all(parts), cells, primitives);
}

TEST(SolveCells, TakesCoresOfUpTo64Primitives) {
  EXPECT_FALSE(row_of_intersections(65).solve().has_value());
  const Labelled labelled = row_of_intersections(64);
  const std::optional<CellSolution> solution = labelled.solve({.minimal = {.table_limit = 0, .combination_limit = 0}});
  ASSERT_TRUE(solution.has_value());
  EXPECT_TRUE(has_labels(solution->tree, labelled, 1));
  EXPECT_EQ(solution->cores, std::vector<std::size_t>{64});
  EXPECT_EQ(solution->peeled, 0U);
}

TEST(SolveCells, SolvesCoresThatShareNothingOneByOne) {
  const Labelled labelled = row_of_intersections(80, {39});
  const std::optional<CellSolution> solution = labelled.solve({.minimal = {.table_limit = 0, .combination_limit = 0}});
  ASSERT_TRUE(solution.has_value());
  EXPECT_TRUE(has_labels(solution->tree, labelled, 1));
  EXPECT_EQ(solution->cores, (std::vector<std::size_t>{40, 40}));
}

/// Boxes in boxes, in and out in turn: each becomes the outermost once those around it are gone.
TEST(SolveCells, SplitsOffWhatIsWhollyInOrOutAgainAndAgain) {
  constexpr std::size_t k_boxes = 9;
  std::set<Cell> cells{Cell{}};
  CsgTree truth = CsgTree::empty();
  for (PrimitiveIndex p = 0; p < k_boxes; ++p) {
    Cell cell(p + 1);
    std::iota(cell.begin(), cell.end(), 0U);
    cells.insert(cell);
    truth = p % 2 == 0 ? unite(truth, CsgTree::leaf(p)) : subtract(truth, CsgTree::leaf(p));
  }
  const Labelled labelled = labelled_by(truth, cells, k_boxes);
  const std::optional<CellSolution> solution = labelled.solve();
  ASSERT_TRUE(solution.has_value());
  EXPECT_TRUE(has_labels(solution->tree, labelled, 1));
  EXPECT_EQ(solution->peeled, k_boxes);
  EXPECT_TRUE(solution->cores.empty());
  EXPECT_TRUE(solution->is_minimal());
  EXPECT_EQ(leaf_count(solution->tree), k_boxes);
}

/// Nothing is split off where only one of two is in: an exclusive or needs each twice, which is proved.
TEST(SolveCells, ProvesThatACoreIsMinimal) {
  const CsgTree a = CsgTree::leaf(0);
  const CsgTree b = CsgTree::leaf(1);
  const CsgTree truth = unite(subtract(a, b), subtract(b, a));
  const Labelled labelled = labelled_by(truth, {{}, {0}, {1}, {0, 1}}, 2);
  const std::optional<CellSolution> solution = labelled.solve();
  ASSERT_TRUE(solution.has_value());
  EXPECT_TRUE(has_labels(solution->tree, labelled, 1));
  EXPECT_EQ(leaf_count(solution->tree), 4U);
  EXPECT_TRUE(solution->is_minimal());
  EXPECT_EQ(solution->cores, std::vector<std::size_t>{2});
}

/// A second copy of a primitive may stand for it: that is no reason to doubt that the tree is minimal.
TEST(SolveCells, ProvesThatItIsMinimalBesideCopies) {
  const CsgTree a = CsgTree::leaf(0);
  const CsgTree b = CsgTree::leaf(1);
  const CsgTree truth = unite(subtract(a, b), subtract(b, a));
  const Labelled labelled = labelled_by(truth, {{}, {0, 2}, {1}, {0, 1, 2}}, 3);
  const std::optional<CellSolution> solution = labelled.solve();
  ASSERT_TRUE(solution.has_value());
  EXPECT_TRUE(has_labels(solution->tree, labelled, 1));
  EXPECT_EQ(leaf_count(solution->tree), 4U);
  EXPECT_EQ(solution->least_leaves, 4U);
}

/// Of three primitives any two tell the cells apart, and which two are taken changes what the rest needs.
TEST(SolveCells, ProvesWhatIsLeastWhateverIsLeftOut) {
  RandomStream random(7);
  std::size_t proved = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::set<Cell> cells{Cell{}};
    while (cells.size() < 9) cells.insert(random_cell(6, random));
    const CsgTree truth = random_chain(random_leaves(6, 7, random), random);
    const Labelled labelled = labelled_by(truth, cells, 6);
    const std::optional<CellSolution> solution = labelled.solve();
    ASSERT_TRUE(solution.has_value());
    EXPECT_LE(solution->least_leaves.value_or(0), leaf_count(truth));
    proved += solution->is_minimal() ? 1 : 0;
  }
  EXPECT_GT(proved, 190U);
}

/// A sliver that only a point or two speak of is not worth a leaf.
TEST(SolveCells, TreatsUnsureCellsAsItLikes) {
  const CsgTree truth = subtract(CsgTree::leaf(0), CsgTree::leaf(1));
  Labelled labelled = labelled_by(truth, {{}, {0}, {0, 1}}, 2);
  labelled.complex.patches = {{.first = 0, .second = 1, .first_in = 0, .second_in = 200, .area = 20},
                              {.first = 1, .second = 2, .first_in = 2, .second_in = 0, .area = 0.2}};
  labelled.labels = label_cells(labelled.complex);
  EXPECT_EQ(labelled.labels.is_in, (std::vector<bool>{false, true, false}));
  const std::optional<CellSolution> solution = labelled.solve();
  ASSERT_TRUE(solution.has_value());
  EXPECT_EQ(solution->tree, CsgTree::leaf(0));
  EXPECT_EQ(solution->open_cells.size(), 1U);
  EXPECT_GT(solution->cost, labelled.labels.cost);
  const std::optional<CellSolution> exact = labelled.solve({.leaf_cost = 0});
  ASSERT_TRUE(exact.has_value());
  EXPECT_EQ(exact->tree, truth);
  EXPECT_TRUE(exact->open_cells.empty());
}

TEST(SolveCells, OfNothingIsEmpty) {
  const Labelled labelled = labelled_by(CsgTree::empty(), {{}, {0}, {1}, {0, 1}}, 2);
  const std::optional<CellSolution> solution = labelled.solve();
  ASSERT_TRUE(solution.has_value());
  EXPECT_EQ(solution->tree, CsgTree::empty());
  EXPECT_TRUE(solution->is_minimal());
}

}  // namespace
}  // namespace cloud2csg
