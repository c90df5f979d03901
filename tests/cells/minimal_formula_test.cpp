#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "cells/random_formulas.hpp"
#include "cloud2csg/advanced/formula.hpp"

namespace cloud2csg {
namespace {

using Variables = std::vector<PrimitiveIndex>;

Variables true_variables(std::size_t assignment, std::size_t variables) {
  Variables inside;
  for (PrimitiveIndex v = 0; v < variables; ++v) {
    if ((assignment >> v & 1U) != 0) inside.push_back(v);
  }
  return inside;
}

/// What a tree says in all assignments, or in those that `keep` picks.
template <class Keep>
PartialFunction function_of(const CsgTree& tree, std::size_t variables, Keep&& keep) {
  PartialFunction function(variables);
  for (std::size_t assignment = 0; assignment < std::size_t{1} << variables; ++assignment) {
    if (!keep()) continue;
    const Variables inside = true_variables(assignment, variables);
    std::vector<bool> is_inside(variables);
    for (const PrimitiveIndex v : inside) is_inside[v] = true;
    function.add(inside, contains(tree, is_inside));
  }
  return function;
}

PartialFunction function_of(const CsgTree& tree, std::size_t variables) {
  return function_of(tree, variables, [] { return true; });
}

bool has_complement_only_at_root(const CsgTree& tree) {
  const auto inner = tree.nodes().first(tree.size() - 1);
  return std::ranges::none_of(inner, [](CsgNode node) { return node.operation() == Operation::complement; });
}

/// Whether a result keeps all that is promised, but that nothing smaller agrees.
bool keeps_promises(const MinimalFormula& result, const PartialFunction& function) {
  const std::size_t leaves = leaf_count(result.tree);
  return agrees(result.tree, function) && has_complement_only_at_root(result.tree) && result.least_leaves <= leaves &&
         result.is_minimal == (result.least_leaves == leaves);
}

std::size_t least_leaves_of(const PartialFunction& function) {
  const std::optional<MinimalFormula> result = minimal_formula(function);
  if (!result || !keeps_promises(*result, function) || !result->is_minimal) {
    ADD_FAILURE() << "no minimal formula";
    return 0;
  }
  return leaf_count(result->tree);
}

/// The least leaves of all functions of 3 variables, each a byte with a bit an assignment: formulas without
/// complements are joined in all ways until nothing new comes; a complement may then be put at the root.
std::vector<std::size_t> least_leaves_of_three_variables() {
  constexpr std::size_t k_none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> least(256, k_none);
  least[0] = 0;
  for (const std::size_t variable : {0b10101010U, 0b11001100U, 0b11110000U}) least[variable] = 1;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 1; a < 256; ++a) {
      for (std::size_t b = 1; b < 256; ++b) {
        if (least[a] == k_none || least[b] == k_none) continue;
        for (const std::size_t joined : {a | b, a & b, a & ~b}) {
          if (least[joined] <= least[a] + least[b]) continue;
          least[joined] = least[a] + least[b];
          changed = true;
        }
      }
    }
  }
  for (std::size_t a = 0; a < 128; ++a) least[a] = least[255 - a] = std::min(least[a], least[255 - a]);
  return least;
}

/// A function and the least number of leaves of all that it may become.
struct Expected {
  PartialFunction function{3};
  std::size_t leaves = std::numeric_limits<std::size_t>::max();
};

/// All 3^8: each assignment is in, out or not known.
std::vector<Expected> partial_functions_of_three_variables() {
  const std::vector<std::size_t> least = least_leaves_of_three_variables();
  std::vector<Expected> all(6561);
  for (std::size_t code = 0; code < all.size(); ++code) {
    std::size_t known = 0;
    std::size_t values = 0;
    for (std::size_t assignment = 0, rest = code; assignment < 8; ++assignment, rest /= 3) {
      if (rest % 3 == 2) continue;
      known |= std::size_t{1} << assignment;
      values |= (rest % 3) << assignment;
      all[code].function.add(true_variables(assignment, 3), rest % 3 == 1);
    }
    for (std::size_t whole = 0; whole < 256; ++whole) {
      if ((whole & known) == values) all[code].leaves = std::min(all[code].leaves, least[whole]);
    }
  }
  return all;
}

TEST(MinimalFormula, IsTheSmallestForAllPartialFunctionsOfThreeVariables) {
  for (const Expected& expected : partial_functions_of_three_variables()) {
    ASSERT_EQ(least_leaves_of(expected.function), expected.leaves);
  }
}

/// The fewer functions are listed, the more is left to the search.
TEST(MinimalFormula, ProvesWhatIsTrueHoweverFewFunctionsAreListed) {
  for (const Expected& expected : partial_functions_of_three_variables()) {
    for (const std::size_t limit : {0U, 10U, 30U}) {
      const std::optional<MinimalFormula> result = minimal_formula(expected.function, {.table_limit = limit});
      ASSERT_TRUE(result && keeps_promises(*result, expected.function));
      ASSERT_LE(result->least_leaves, expected.leaves);
      ASSERT_GE(leaf_count(result->tree), expected.leaves);
    }
  }
}

RC_GTEST_PROP(MinimalFormula, IsAsLargeHoweverFewFunctionsAreListed, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t variables = 4 + random.below(2);
  PartialFunction function(variables);
  for (std::size_t assignment = 0; assignment < std::size_t{1} << variables; ++assignment) {
    if (random.chance(0.6)) function.add(true_variables(assignment, variables), random.chance(0.5));
  }
  const std::optional<MinimalFormula> minimal = minimal_formula(function);
  RC_PRE(minimal && minimal->is_minimal);  // of some functions of five variables that takes more work than is allowed
  const std::size_t least = leaf_count(minimal->tree);
  const std::optional<MinimalFormula> other =
      minimal_formula(function, {.table_limit = random.below(1000), .combination_limit = 20'000'000});
  RC_ASSERT(keeps_promises(*minimal, function));
  RC_ASSERT(keeps_promises(*other, function));
  RC_ASSERT(other->least_leaves <= least);
  RC_ASSERT(leaf_count(other->tree) >= least);
}

RC_GTEST_PROP(MinimalFormula, FindsReadOnceFormulas, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t variables = 2 + random.below(5);
  const CsgTree tree = test::random_read_once_formula(variables, random);
  RC_ASSERT(least_leaves_of(function_of(tree, variables)) == variables);
}

RC_GTEST_PROP(MinimalFormula, IsNeverLargerThanTheFormulaThatRowsAreTakenFrom, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t variables = 2 + random.below(5);
  Variables leaves(variables + random.below(3));
  for (PrimitiveIndex& leaf : leaves) leaf = random.below(variables);
  const CsgTree tree = test::random_formula(leaves, random);
  const double share = random.uniform();
  const PartialFunction some = function_of(tree, variables, [&] { return random.chance(share); });
  const std::size_t least = least_leaves_of(some);
  RC_ASSERT(least <= leaves.size());
  RC_ASSERT(least <= least_leaves_of(function_of(tree, variables)));
}

/// Random values need many leaves: where no proof is reached, there is still a formula.
RC_GTEST_PROP(MinimalFormula, GivesAFormulaOfAnyFunctionAtAnyLimit, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t variables = 1 + random.below(8);
  PartialFunction function(variables);
  for (std::size_t assignment = 0; assignment < std::size_t{1} << variables; ++assignment) {
    if (random.chance(0.5)) function.add(true_variables(assignment, variables), random.chance(0.5));
  }
  const MinimalFormulaOptions options{.table_limit = random.below(2000), .combination_limit = random.below(200'000)};
  const std::optional<MinimalFormula> result = minimal_formula(function, options);
  RC_ASSERT(result.has_value());
  RC_ASSERT(keeps_promises(*result, function));
  RC_ASSERT(minimal_formula(function, options)->tree == result->tree);
}

class KnownFunctions : public testing::Test {
 protected:
  const CsgTree a_ = CsgTree::leaf(0);
  const CsgTree b_ = CsgTree::leaf(1);
  const CsgTree c_ = CsgTree::leaf(2);
};

TEST_F(KnownFunctions, AreRepeatedWhereTheyMustBe) {
  const CsgTree either = unite(subtract(a_, b_), subtract(b_, a_));
  EXPECT_EQ(least_leaves_of(function_of(either, 2)), 4U);
  EXPECT_EQ(least_leaves_of(function_of(unite(subtract(either, c_), subtract(c_, either)), 3)), 10U);
  EXPECT_EQ(least_leaves_of(function_of(unite(intersect(a_, b_), intersect(c_, unite(a_, b_))), 3)), 5U);
  EXPECT_EQ(least_leaves_of(function_of(unite(intersect(c_, a_), subtract(b_, c_)), 3)), 4U);
}

TEST_F(KnownFunctions, AreProvedOnlyWithinTheLimits) {
  const CsgTree either = unite(subtract(a_, b_), subtract(b_, a_));
  const PartialFunction odd = function_of(unite(subtract(either, c_), subtract(c_, either)), 3);
  std::stop_source stop;
  stop.request_stop();
  for (const std::optional<MinimalFormula>& result :
       {minimal_formula(odd, {.combination_limit = 0}), minimal_formula(odd, {.table_limit = 0}),
        minimal_formula(odd, {}, {.stop = stop.get_token()})}) {
    ASSERT_TRUE(result.has_value());
    EXPECT_TRUE(keeps_promises(*result, odd));
    EXPECT_FALSE(result->is_minimal);
    EXPECT_GE(leaf_count(result->tree), 10U);
  }
}

TEST_F(KnownFunctions, MayBeConstant) {
  for (const CsgTree& tree : {CsgTree::empty(), CsgTree::full()}) {
    const std::optional<MinimalFormula> result = minimal_formula(function_of(tree, 2));
    EXPECT_EQ(result->tree, tree);
    EXPECT_TRUE(result->is_minimal);
    EXPECT_EQ(result->least_leaves, 0U);
  }
  EXPECT_EQ(minimal_formula(PartialFunction(3))->tree, CsgTree::empty());
}

TEST_F(KnownFunctions, MayBeOneVariableOrItsComplement) {
  EXPECT_EQ(minimal_formula(function_of(b_, 3))->tree, b_);
  EXPECT_EQ(minimal_formula(function_of(complement(b_), 3))->tree, complement(b_));
}

TEST_F(KnownFunctions, HaveTheirComplementAtTheRoot) {
  EXPECT_EQ(minimal_formula(function_of(complement(unite(a_, b_)), 2))->tree, complement(unite(a_, b_)));
  EXPECT_EQ(minimal_formula(function_of(unite(complement(a_), b_), 2))->tree, complement(subtract(a_, b_)));
}

TEST_F(KnownFunctions, UseVariablesThatTellRowsApart) {
  // The first is true everywhere, the second and third are always equal, the fourth is their complement.
  PartialFunction function(5);
  function.add(Variables{0, 1, 2}, true);
  function.add(Variables{0, 1, 2, 4}, false);
  function.add(Variables{0, 3}, false);
  function.add(Variables{0, 3, 4}, false);
  function.add(Variables{0, 3, 4}, false);
  EXPECT_EQ(minimal_formula(function)->tree, subtract(b_, CsgTree::leaf(4)));
}

TEST(MinimalFormula, HasRowsOfManyWords) {
  RandomStream random(6);
  for (const std::size_t variables : {7U, 8U, 9U}) {
    const CsgTree tree = test::random_read_once_formula(variables, random);
    EXPECT_EQ(least_leaves_of(function_of(tree, variables)), variables);
  }
}

TEST(MinimalFormula, IsNotLookedForInTooManyRows) {
  RandomStream random(7);
  EXPECT_FALSE(minimal_formula(function_of(test::random_read_once_formula(10, random), 10)).has_value());
}

}  // namespace
}  // namespace cloud2csg
