#include "cells/decompose.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <map>

#include "cells/random_formulas.hpp"
#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {
namespace {

Assignment bit_of(std::size_t variable) {
  return Assignment{1} << variable;
}

bool value_of(const CsgTree& tree, Assignment row) {
  std::vector<bool> inside(k_most_variables);
  for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = (row >> v & 1U) != 0;
  return contains(tree, inside);
}

void add_row(KnownRows& rows, const CsgTree& tree, Assignment row) {
  (value_of(tree, row) ? rows.on : rows.off).push_back(row);
}

KnownRows all_rows_of(const CsgTree& tree, std::size_t variables) {
  KnownRows rows;
  for (Assignment row = 0; row < bit_of(variables); ++row) add_row(rows, tree, row);
  return rows;
}

bool agrees(const CsgTree& tree, const KnownRows& rows) {
  return std::ranges::all_of(rows.on, [&](Assignment row) { return value_of(tree, row); }) &&
         std::ranges::none_of(rows.off, [&](Assignment row) { return value_of(tree, row); });
}

/// Each variable once; a complement at the root, maybe.
CsgTree random_read_once_tree(std::size_t variables, RandomStream& random) {
  const CsgTree tree = test::random_read_once_formula(variables, random);
  return random.chance(0.2) ? complement(tree) : tree;
}

/// Assignments with random values.
KnownRows random_rows(std::size_t variables, std::size_t count, RandomStream& random) {
  std::map<Assignment, bool> values;
  for (std::size_t i = 0; i < count; ++i) values[random.next() & (bit_of(variables) - 1)] = random.chance(0.5);
  KnownRows rows;
  for (const auto& [row, value] : values) (value ? rows.on : rows.off).push_back(row);
  return rows;
}

RC_GTEST_PROP(Decompose, FindsReadOnceFormulas, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t variables = 1 + random.below(8);
  const KnownRows rows = all_rows_of(random_read_once_tree(variables, random), variables);
  const CsgTree tree = decompose(rows);
  RC_ASSERT(agrees(tree, rows));
  RC_ASSERT(leaf_count(tree) == variables);
}

/// As cells are known: those around some places, one step away.
RC_GTEST_PROP(Decompose, AgreesWithSomeRowsOfReadOnceFormulas, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t variables = 2 + random.below(11);
  const CsgTree truth = random_read_once_tree(variables, random);
  KnownRows rows;
  const std::size_t places = 1 + random.below(12);
  for (std::size_t i = 0; i < places; ++i) {
    const Assignment row = random.next() & (bit_of(variables) - 1);
    add_row(rows, truth, row);
    for (std::size_t v = 0; v < variables; ++v) add_row(rows, truth, row ^ bit_of(v));
  }
  const CsgTree tree = decompose(rows);
  RC_ASSERT(agrees(tree, rows));
  RC_ASSERT(leaf_count(tree) >= static_cast<std::size_t>(std::popcount(essential_variables(rows))));
}

RC_GTEST_PROP(Decompose, AgreesWithAnyRowsAtAnyBudget, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t variables = 1 + random.below(10);
  const KnownRows rows = random_rows(variables, random.below(40), random);
  for (const std::size_t budget : {std::size_t{0}, std::size_t{random.below(50)}, std::size_t{200}}) {
    const CsgTree tree = decompose(rows, {.budget = budget});
    RC_ASSERT(agrees(tree, rows));
    RC_ASSERT(decompose(rows, {.budget = budget}) == tree);
  }
}

RC_GTEST_PROP(Decompose, LeavesOutWhatNothingDependsOn, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t variables = 1 + random.below(5);
  KnownRows rows;
  const KnownRows needed = all_rows_of(random_read_once_tree(variables, random), variables);
  const auto spread = [&](const std::vector<Assignment>& from, std::vector<Assignment>& to) {
    for (const Assignment row : from) {
      for (int copy = 0; copy < 3; ++copy) to.push_back(row | (random.next() & 0xffff0000));
    }
  };
  spread(needed.on, rows.on);
  spread(needed.off, rows.off);
  const CsgTree tree = decompose(rows);
  RC_ASSERT(agrees(tree, rows));
  RC_ASSERT(primitives_of(tree).back() < variables);
  RC_ASSERT(leaf_count(tree) == variables);
}

RC_GTEST_PROP(EssentialVariables, TellTwoRowsApartAlone, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t variables = 1 + random.below(8);
  const KnownRows rows = random_rows(variables, random.below(80), random);
  Assignment expected = 0;
  for (const Assignment on : rows.on) {
    for (const Assignment off : rows.off) {
      if (std::has_single_bit(on ^ off)) expected |= on ^ off;
    }
  }
  RC_ASSERT(essential_variables(rows) == expected);
}

TEST(Decompose, OfAConstantHasNoVariables) {
  EXPECT_EQ(decompose({}), CsgTree::empty());
  EXPECT_EQ(decompose({.on = {}, .off = {0, 1, 2}}), CsgTree::empty());
  EXPECT_EQ(decompose({.on = {0, 5}, .off = {}}), CsgTree::full());
}

TEST(Decompose, TakesRowsThatComeTwice) {
  EXPECT_EQ(simplify(decompose({.on = {2, 3, 2, 3}, .off = {1, 0, 1}})), CsgTree::leaf(1));
}

class Repeated : public ::testing::Test {
 protected:
  /// Of all rows over three variables.
  static void expect_leaves(const CsgTree& truth, std::size_t leaves) {
    const KnownRows rows = all_rows_of(truth, 3);
    const CsgTree tree = decompose(rows);
    EXPECT_TRUE(agrees(tree, rows));
    EXPECT_EQ(leaf_count(tree), leaves);
  }

  const CsgTree a_ = CsgTree::leaf(0);
  const CsgTree b_ = CsgTree::leaf(1);
  const CsgTree c_ = CsgTree::leaf(2);
};

TEST_F(Repeated, VariablesOfAnExclusiveOr) {
  const CsgTree either = unite(subtract(a_, b_), subtract(b_, a_));
  expect_leaves(either, 4);
  expect_leaves(unite(subtract(either, c_), subtract(c_, either)), 10);
}

TEST_F(Repeated, VariablesOfAMajority) {
  expect_leaves(unite(intersect(a_, b_), intersect(c_, unite(a_, b_))), 5);
}

TEST_F(Repeated, VariablesOfAChoice) {
  expect_leaves(unite(intersect(c_, a_), subtract(b_, c_)), 4);
}

/// A row of plates with a hole each.
TEST(Decompose, TakesAsManyVariablesAsThereAreBits) {
  KnownRows rows{.on = {}, .off = {0}};
  std::vector<CsgTree> parts;
  for (PrimitiveIndex plate = 0; plate < k_most_variables; plate += 2) {
    parts.push_back(subtract(CsgTree::leaf(plate), CsgTree::leaf(plate + 1)));
    rows.on.push_back(bit_of(plate));
    rows.off.push_back(bit_of(plate) | bit_of(plate + 1));
    rows.off.push_back(bit_of(plate + 1));
  }
  const CsgTree truth = unite_all(parts);
  RandomStream random(1);
  for (int i = 0; i < 300; ++i) add_row(rows, truth, random.next() & random.next() & random.next());
  const CsgTree tree = decompose(rows);
  EXPECT_TRUE(agrees(tree, rows));
  EXPECT_EQ(leaf_count(tree), k_most_variables);
}

/// What two neighbours share, all along a row: each but the ends appears twice, or nearly.
TEST(Decompose, TakesAsManyVariablesAsThereAreBitsWhereTheyRepeat) {
  KnownRows rows{.on = {}, .off = {0}};
  for (std::size_t v = 0; v < k_most_variables; ++v) rows.off.push_back(bit_of(v));
  for (std::size_t v = 0; v + 1 < k_most_variables; ++v) rows.on.push_back(bit_of(v) | bit_of(v + 1));
  const CsgTree tree = decompose(rows);
  EXPECT_TRUE(agrees(tree, rows));
  EXPECT_LE(leaf_count(tree), 2 * (k_most_variables - 1));
}

}  // namespace
}  // namespace cloud2csg
