#include "io/scripts/script_plan.hpp"

#include <algorithm>
#include <utility>

#include "cloud2csg/csg_tree.hpp"
#include "io/step/solid_plan.hpp"
#include "shape/mesh/model_extent.hpp"

namespace cloud2csg::script {
namespace {

using Kind = Step::Kind;

bool has_constants(const CsgTree& tree) {
  return std::any_of(tree.nodes().begin(), tree.nodes().end(), [](const CsgNode& node) {
    return node.operation() == Operation::empty || node.operation() == Operation::full;
  });
}

Step step_of(const brep::PlanNode& node, const std::vector<std::size_t>& place) {
  const auto placed = [&place](const std::vector<std::size_t>& operands) {
    std::vector<std::size_t> steps;
    steps.reserve(operands.size());
    for (const std::size_t operand : operands) steps.push_back(place[operand]);
    return steps;
  };
  const Kind kind = node.kind == brep::PlanNode::Kind::primitive  ? Kind::primitive
                    : node.kind == brep::PlanNode::Kind::union_of ? Kind::union_of
                                                                  : Kind::common;
  return {.kind = kind, .primitive = node.primitive, .kept = placed(node.kept), .removed = placed(node.removed)};
}

std::vector<Step> steps_of(const brep::SolidPlan& solid) {
  std::vector<std::size_t> needed;
  for (const std::vector<std::size_t>& level : brep::levels_of(solid)) {
    needed.insert(needed.end(), level.begin(), level.end());
  }
  std::sort(needed.begin(), needed.end());
  std::vector<std::size_t> place(solid.nodes.size(), 0);
  std::vector<Step> steps;
  steps.reserve(needed.size() + 2);
  for (const std::size_t node : needed) {
    place[node] = steps.size();
    steps.push_back(step_of(solid.nodes[node], place));
  }
  return steps;
}

/// Intersects the last step with the box of everything, or subtracts it from the box. Inserts the box before it.
void bound(std::vector<Step>& steps, bool is_complement) {
  Step last = std::move(steps.back());
  const std::size_t box = steps.size() - 1;
  steps.back() = {.kind = Kind::everything};
  if (is_complement) {
    if (last.kind == Kind::union_of) {
      // If the removed solid is empty, the box remains.
      if (!last.kept.empty()) steps.push_back({.kind = Kind::common, .kept = {box}, .removed = std::move(last.kept)});
      return;
    }
  } else if (last.kind == Kind::common) {
    last.kept.insert(last.kept.begin(), box);
    steps.push_back(std::move(last));
    return;
  }
  steps.push_back(std::move(last));
  const std::size_t solid = steps.size() - 1;
  Step bounded{.kind = Kind::common, .kept = {box}};
  (is_complement ? bounded.removed : bounded.kept).push_back(solid);
  steps.push_back(std::move(bounded));
}

}  // namespace

Plan plan_script(const Model& model) {
  // No script has a word for an empty or infinite solid, so simplify() removes as many constants as possible.
  const CsgTree& tree = tree_of(model);
  const brep::SolidPlan solid = brep::plan_solid(has_constants(tree) ? simplify(tree) : tree);
  Plan plan{.steps = steps_of(solid), .everything = model_extent(model)};
  if (solid.is_complement || cut_at(model, plan.everything)) bound(plan.steps, solid.is_complement);
  return plan;
}

bool is_empty(const Plan& plan) {
  return plan.steps.back().kind == Kind::union_of && plan.steps.back().kept.empty();
}

std::vector<PrimitiveIndex> primitives_of(const Plan& plan) {
  std::vector<PrimitiveIndex> used;
  for (const Step& step : plan.steps) {
    if (step.kind == Kind::primitive) used.push_back(step.primitive);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

}  // namespace cloud2csg::script
