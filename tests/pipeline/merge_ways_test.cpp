#include <gtest/gtest.h>

#include <stop_token>

#include "cloud2csg/extract.hpp"
#include "paper/merge/merge_component.hpp"
#include "pipeline/strategies.hpp"
#include "support/known_solids.hpp"
#include "support/scene.hpp"

namespace cloud2csg {
namespace {

/// A and B overlap, C touches only A, D only B.
PrimitiveSet a_chain() {
  return {test::placed("a", Box{{1, 0.8, 0.8}}, {-0.3, 0, 0}), test::placed("b", Box{{1, 0.6, 0.6}}, {0.3, 0, 0}),
          test::placed("c", Sphere{0.3}, {-0.8, 0, 0}), test::placed("d", Sphere{0.25}, {0.8, 0, 0})};
}

PointCloud cloud_of(const char* formula, const PrimitiveSet& primitives) {
  return sample_surface({.primitives = primitives, .tree = parse_tree(formula, primitives)},
                        {.count = 8000, .noise = 0.004, .seed = 3});
}

class Chain : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Formulas, Chain,
                         ::testing::Values("((a | b) - c) - d", "((a | b) | c) - d", "(a - c) | (b - d)",
                                           "((a & b) | c) | d", "(a - b) | c", "((a - b) - c) | d", "((b - a) | c) - d",
                                           "(a & b) | d"));

TEST_P(Chain, IsRightHoweverItIsMerged) {
  const PrimitiveSet primitives = a_chain();
  const CsgTree truth = parse_tree(GetParam(), primitives);
  const PointCloud cloud = cloud_of(GetParam(), primitives);
  for (const ExtractOptions& options : test::all_strategies()) {
    const Extraction result = extract_csg(cloud, primitives, options);
    EXPECT_GE(test::membership_iou(result.tree(), truth, primitives), 0.999)
        << to_string(options.strategy) << ": " << to_text(result.tree(), primitives);
    if (result.statistics.cells) {
      EXPECT_TRUE(result.statistics.merge.ways.empty());
      continue;
    }
    ASSERT_EQ(result.statistics.merge.ways.size(), result.statistics.components);
    if (options.strategy != Strategy::partition) {
      EXPECT_EQ(result.statistics.merge.ways.front(), MergeWay::single);
    }
  }
}

TEST(MergeWays, ThePapersWayIsTakenWhereItGoesThrough) {
  const PrimitiveSet primitives = a_chain();
  const Extraction result =
      extract_csg(cloud_of("((a | b) | c) - d", primitives), primitives, {.strategy = Strategy::partition});
  EXPECT_EQ(result.statistics.merge.ways, std::vector{MergeWay::paper});
  EXPECT_EQ(result.statistics.merge.merges, 2U);
  EXPECT_EQ(result.statistics.merge.failed_checks, 0U);
  EXPECT_LT(result.statistics.merge.worst_shortfall, 0.05);
}

/// The solid lies within a & b only, so that the tree of a and b is an intersection, which the paper cannot merge into.
TEST(MergeWays, AnIntersectionOnTheWayIsNotTheEnd) {
  const PrimitiveSet primitives = a_chain();
  const CsgTree truth = parse_tree("((a & b) | c) | d", primitives);
  const Extraction result = extract_csg(cloud_of("((a & b) | c) | d", primitives), primitives,
                                        {.strategy = Strategy::partition, .without_strangers = false});
  EXPECT_NE(result.statistics.merge.ways, std::vector{MergeWay::paper});
  EXPECT_GE(test::membership_iou(result.tree(), truth, primitives), 0.999);
  EXPECT_GT(result.statistics.merge.blocked + result.statistics.merge.failed_checks, 0U);
  EXPECT_LT(result.statistics.merge.worst_shortfall, 0.05);
}

/// Components put together by hand, to see what becomes of partition trees that are wrong.
class HandMade : public ::testing::Test {
 protected:
  HandMade()
      : primitives_{test::placed("a", Box{{2, 2, 1}}, {0, 0, 0}), test::placed("b", Cylinder{0.4, 2}, {0, 0, 0}),
                    test::placed("c", Sphere{0.3}, {1, 0, 0}), test::placed("d", Sphere{0.3}, {-1, 0, 0})},
        truth_(parse_tree("((a | c) - b) - d", primitives_)),
        table_(test::whole_table({.primitives = primitives_, .cloud = cloud_of("((a | c) - b) - d", primitives_)})) {}

  [[nodiscard]] MergedComponent merge(const std::vector<Clique>& cliques, const std::vector<const char*>& texts,
                                      const RunContext& run = {}) {
    Component component{.primitives = 4,
                        .windows = {{.table = &table_, .primitives = {0, 1, 2, 3}}},
                        .alpha = table_.objective().alpha,
                        .cliques = cliques,
                        .trees = {}};
    for (const char* text : texts) component.trees.push_back(parse_tree(text, primitives_));
    const SolveJointly solve_jointly = [this](const Clique& clique) {
      asked_for_.push_back(clique);
      return joint_answer_;
    };
    return merge_component(component, solve_jointly, {.search = search_, .polish = true, .item = 1}, run);
  }

  void expect_truth(const MergedComponent& merged) const {
    EXPECT_EQ(test::membership_iou(merged.tree, truth_, primitives_), 1.0) << to_text(merged.tree, primitives_);
    EXPECT_LT(merged.statistics.worst_shortfall, 0.05);
    EXPECT_TRUE(merged.complete);
  }

  PrimitiveSet primitives_;
  CsgTree truth_;
  RankClasses table_;
  GaOptions search_;
  CsgTree joint_answer_ = CsgTree::leaf(0);
  std::vector<Clique> asked_for_;
};

TEST_F(HandMade, TreesThatAgreeMergeInTheWayOfThePaper) {
  const MergedComponent merged = merge({{0, 1}, {0, 2}, {0, 3}}, {"a - b", "a | c", "a - d"});
  expect_truth(merged);
  EXPECT_EQ(merged.statistics.ways, std::vector{MergeWay::paper});
  EXPECT_TRUE(asked_for_.empty());
  EXPECT_EQ(merged.statistics.evaluations > 0, true);  // polish looks for nodes to take out
}

TEST_F(HandMade, AWrongPartitionTreeIsOverruled) {
  const MergedComponent merged = merge({{0, 1}, {0, 1, 2}, {0, 3}}, {"a - b", "(a | b) | c", "a - d"});
  expect_truth(merged);
}

TEST_F(HandMade, TreesThatContradictEachOtherToNothingAreOverruled) {
  // b - a takes the place of a: (b - a) - b is empty.
  const MergedComponent merged = merge({{0, 1}, {0, 1}}, {"a - b", "b - a"});
  expect_truth(merged);
  EXPECT_EQ(merged.statistics.ways, std::vector{MergeWay::search});
}

TEST_F(HandMade, BlockedTreesAreSolvedTogether) {
  joint_answer_ = truth_;
  // The second shares c and a with the first, but both stand in an intersection.
  const MergedComponent merged = merge({{0, 1, 2}, {0, 2, 3}}, {"(a | c) & ~b", "(a | c) & ~d"});
  expect_truth(merged);
}

TEST_F(HandMade, OnlyWrongTreesLeadToASearch) {
  joint_answer_ = CsgTree::leaf(1);
  const MergedComponent merged = merge({{0, 1}, {0, 2}, {0, 3}}, {"a & b", "a & c", "a & d"});
  expect_truth(merged);
  EXPECT_EQ(merged.statistics.ways, std::vector{MergeWay::search});
  EXPECT_GT(merged.statistics.joint_solutions, 0U);
  EXPECT_FALSE(asked_for_.empty());
}

TEST_F(HandMade, EmptyAndFullTreesAreOverruledToo) {
  expect_truth(merge({{0, 1}, {0, 2, 3}}, {"~(a - a)", "~(c - c)"}));
  expect_truth(merge({{0, 1}, {0, 2, 3}}, {"a - a", "c - c"}));
}

TEST_F(HandMade, StoppedItGivesTheBestItMet) {
  std::stop_source stop;
  stop.request_stop();
  const MergedComponent merged =
      merge({{0, 1}, {0, 2}, {0, 3}}, {"a & b", "a & c", "a & d"}, {.stop = stop.get_token()});
  EXPECT_FALSE(merged.complete);
  EXPECT_FALSE(primitives_of(merged.tree).empty());
  EXPECT_TRUE(asked_for_.empty());
}

TEST_F(HandMade, PolishTakesOutWhatScoresNothing) {
  const MergedComponent merged = merge({{0, 1, 2, 3}}, {"(((a | c) - b) - d) | (b & c)"});
  expect_truth(merged);
  EXPECT_EQ(merged.tree.size(), truth_.size());
}

}  // namespace
}  // namespace cloud2csg
