#include "io/step/solid_plan.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "tree/random_trees.hpp"

namespace cloud2csg::brep {
namespace {

using Kind = PlanNode::Kind;

std::vector<bool> complemented(std::vector<bool> table) {
  table.flip();
  return table;
}

RC_GTEST_PROP(SolidPlan, SaysWhatTheTreeSays, (const CsgTree& tree)) {
  constexpr std::size_t k_primitives = 6;
  const SolidPlan plan = plan_solid(tree);
  const std::vector<bool> table = test::truth_table(tree_of(plan, plan.root), k_primitives);
  RC_ASSERT((plan.is_complement ? complemented(table) : table) == test::truth_table(tree, k_primitives));
}

RC_GTEST_PROP(SolidPlan, HasWideOperationsAndNothingTwice, (const CsgTree& tree)) {
  const SolidPlan plan = plan_solid(tree);
  std::vector<int> uses(plan.nodes.size(), 0);
  std::vector<bool> is_made(plan.nodes.size(), false);
  for (const std::vector<std::size_t>& level : levels_of(plan)) {
    for (const std::size_t index : level) {
      const PlanNode& node = plan.nodes[index];
      for (const std::size_t operand : node.kept) {
        RC_ASSERT(is_made[operand]);
        RC_ASSERT(plan.nodes[operand].kind != node.kind);
        ++uses[operand];
      }
      for (const std::size_t operand : node.removed) {
        RC_ASSERT(is_made[operand]);
        RC_ASSERT(plan.nodes[operand].kind != Kind::union_of);
        ++uses[operand];
      }
      RC_ASSERT((node.kind != Kind::common) || !node.kept.empty());
    }
    for (const std::size_t index : level) is_made[index] = true;
  }
  RC_ASSERT(std::all_of(uses.begin(), uses.end(), [](int count) { return count <= 1; }));
  RC_ASSERT(is_made[plan.root]);
}

TEST(SolidPlan, TakesDifferencesTogether) {
  const PrimitiveSet primitives = test::sphere_row(5);
  const SolidPlan plan = plan_solid(parse_tree("(p0 - p1 - (p2 | p3)) & ~p4", primitives));
  const PlanNode& root = plan.nodes[plan.root];
  EXPECT_EQ(root.kind, Kind::common);
  EXPECT_EQ(root.kept.size(), 1U);
  EXPECT_EQ(root.removed.size(), 4U);
  EXPECT_FALSE(plan.is_complement);
}

TEST(SolidPlan, IsLinearInChains) {
  const PrimitiveSet primitives = test::sphere_row(20'000);
  std::vector<CsgNode> nodes{CsgNode::leaf(0)};
  for (PrimitiveIndex i = 1; i < primitives.size(); ++i) {
    nodes.push_back(CsgNode::leaf(i));
    nodes.push_back(CsgNode::inner(Operation::union_of, static_cast<std::uint32_t>(nodes.size() + 1)));
  }
  const SolidPlan plan = plan_solid(CsgTree(std::move(nodes)));
  EXPECT_EQ(plan.nodes[plan.root].kept.size(), primitives.size());
}

}  // namespace
}  // namespace cloud2csg::brep
