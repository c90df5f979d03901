#include "cells/few_levels.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "cells/random_formulas.hpp"
#include "cells/tree_cells.hpp"

namespace cloud2csg {
namespace {

CellComplex complex_of(const std::set<Cell>& cells, std::size_t primitives) {
  CellComplex complex;
  complex.cells.assign(cells.begin(), cells.end());
  complex.points_of_primitive.assign(primitives, 1);
  return complex;
}

std::set<Cell> random_cells(std::size_t primitives, std::size_t count, RandomStream& random) {
  std::set<Cell> cells{{}};
  for (std::size_t i = 0; i < count; ++i) {
    Cell cell;
    for (PrimitiveIndex p = 0; p < primitives; ++p) {
      if (random.chance(0.25)) cell.push_back(p);
    }
    cells.insert(cell);
  }
  return cells;
}

std::vector<PrimitiveIndex> sorted_leaves(const CsgTree& tree) {
  std::vector<PrimitiveIndex> leaves;
  for (const CsgNode node : tree.nodes()) {
    if (node.is_leaf()) leaves.push_back(node.primitive());
  }
  std::ranges::sort(leaves);
  return leaves;
}

CsgTree leaf(PrimitiveIndex p) {
  return CsgTree::leaf(p);
}

RC_GTEST_PROP(FewLevels, KeepCellsAndLeaves, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(16);
  CsgTree tree = test::random_read_once_formula(primitives, random);
  if (random.chance(0.2)) tree = complement(tree);
  if (random.chance(0.3)) tree = unite(tree, test::random_read_once_formula(primitives, random));
  const CellComplex complex = complex_of(random_cells(primitives, random.below(40), random), primitives);
  const CsgTree written = with_few_levels(tree, complex);
  RC_ASSERT(cells_in(written, complex) == cells_in(tree, complex));
  RC_ASSERT(sorted_leaves(written) == sorted_leaves(tree));
  RC_ASSERT(levels(written) <= levels(tree));
}

TEST(FewLevels, OfAChainAreTwo) {
  // Each pin has a bore of its own, in which the next one stands.
  constexpr PrimitiveIndex k_links = 20;
  std::set<Cell> cells{{}};
  CsgTree nested = CsgTree::empty();
  for (PrimitiveIndex link = 0; link < k_links; ++link) {
    const PrimitiveIndex pin = 2 * link;
    const PrimitiveIndex bore = pin + 1;
    cells.insert({{pin}, {bore}, {pin, bore}});
    if (link > 0) cells.insert({{pin - 1, pin}, {pin - 2, pin - 1, pin}});
    nested = subtract(link == 0 ? leaf(pin) : unite(nested, leaf(pin)), leaf(bore));
  }
  const CellComplex complex = complex_of(cells, 2 * k_links);
  ASSERT_GT(levels(nested), k_links);
  const CsgTree written = with_few_levels(nested, complex);
  EXPECT_EQ(levels(written), 2U);
  EXPECT_EQ(cells_in(written, complex), cells_in(nested, complex));
}

TEST(FewLevels, LeaveDifferencesOutermostWhereThatSavesNone) {
  // A plate of two parts, with a hole in each: a union of differences has two levels as well.
  const CsgTree tree = subtract(unite(leaf(0), leaf(1)), unite(leaf(2), leaf(3)));
  const CellComplex complex = complex_of({{}, {0}, {1}, {0, 1}, {0, 2}, {1, 3}, {2}, {3}}, 4);
  EXPECT_EQ(with_few_levels(tree, complex), tree);
}

TEST(FewLevels, TakeFromWhatIsCutOnly) {
  // ((0 - 1) | 2 | 3) - 4, where 4 cuts 2 alone.
  const CsgTree tree = subtract(unite(unite(subtract(leaf(0), leaf(1)), leaf(2)), leaf(3)), leaf(4));
  const CellComplex complex = complex_of({{}, {0}, {0, 1}, {1, 2}, {2}, {2, 4}, {3}, {0, 2}, {2, 3}}, 5);
  const CsgTree written = with_few_levels(tree, complex);
  EXPECT_EQ(levels(tree), 3U);
  EXPECT_EQ(levels(written), 2U);
  EXPECT_EQ(cells_in(written, complex), cells_in(tree, complex));
}

TEST(FewLevels, StayWhereWhatIsTakenAwayCutsAll) {
  const CsgTree tree = subtract(unite(unite(subtract(leaf(0), leaf(1)), leaf(2)), leaf(3)), leaf(4));
  const CellComplex complex = complex_of({{}, {0}, {0, 1}, {1, 2}, {0, 4}, {2}, {2, 4}, {3}, {3, 4}}, 5);
  EXPECT_EQ(with_few_levels(tree, complex), tree);
}

TEST(FewLevels, HoldOutsideOfAll) {
  // All of space but a ball, less another: both reach into every cell.
  const CsgTree tree = subtract(unite(complement(leaf(0)), subtract(leaf(1), leaf(2))), leaf(3));
  const CellComplex complex = complex_of({{}, {0}, {1}, {0, 1}, {0, 1, 2}, {3}, {0, 3}}, 4);
  const CsgTree written = with_few_levels(tree, complex);
  EXPECT_EQ(cells_in(written, complex), cells_in(tree, complex));
}

}  // namespace
}  // namespace cloud2csg
