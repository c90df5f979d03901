#include "io/step/solid_plan.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace cloud2csg::brep {
namespace {

using Kind = PlanNode::Kind;

/// A node of the plan or its complement.
struct Operand {
  std::size_t node;
  bool is_complement;
};

Operand complement_of(const Operand& a) {
  return {.node = a.node, .is_complement = !a.is_complement};
}

void append(std::vector<std::size_t>& list, std::vector<std::size_t> more) {
  if (list.empty()) {
    list = std::move(more);  // avoids copying a chain of thousands at each link
  } else {
    list.insert(list.end(), more.begin(), more.end());
  }
}

class Planner {
 public:
  SolidPlan plan(const CsgTree& tree) {
    for (const CsgNode& node : tree.nodes()) take(node);
    plan_.root = stack_.back().node;
    plan_.is_complement = stack_.back().is_complement;
    return std::move(plan_);
  }

 private:
  void take(const CsgNode& node) {
    switch (node.operation()) {
      case Operation::primitive:
        return push({.kind = Kind::primitive, .primitive = node.primitive()}, false);
      case Operation::empty:
        return push({}, false);
      case Operation::full:
        return push({}, true);
      case Operation::complement:
        stack_.back() = complement_of(stack_.back());
        return;
      case Operation::union_of:
      case Operation::intersection:
      case Operation::difference:
        break;
    }
    Operand second = pop();
    Operand first = pop();
    if (node.operation() == Operation::difference) second = complement_of(second);
    // a | b = ~(~a & ~b)
    const bool is_union = node.operation() == Operation::union_of;
    if (is_union) {
      first = complement_of(first);
      second = complement_of(second);
    }
    intersect(first, second, is_union);
  }

  void intersect(const Operand& first, const Operand& second, bool complemented) {
    PlanNode node;
    if (first.is_complement && second.is_complement) {
      add_to_union(node.kept, first.node);
      add_to_union(node.kept, second.node);
      push(std::move(node), !complemented);
      return;
    }
    node.kind = Kind::common;
    for (const Operand& operand : {first, second}) {
      if (operand.is_complement) {
        add_to_union(node.removed, operand.node);
      } else {
        add_to_common(node, operand.node);
      }
    }
    push(std::move(node), complemented);
  }

  void add_to_union(std::vector<std::size_t>& operands, std::size_t index) {
    PlanNode& operand = plan_.nodes[index];
    append(operands, operand.kind == Kind::union_of ? std::move(operand.kept) : std::vector{index});
  }

  void add_to_common(PlanNode& node, std::size_t index) {
    PlanNode& operand = plan_.nodes[index];
    if (operand.kind != Kind::common) {
      node.kept.push_back(index);
      return;
    }
    append(node.kept, std::move(operand.kept));
    append(node.removed, std::move(operand.removed));
  }

  void push(PlanNode node, bool is_complement) {
    plan_.nodes.push_back(std::move(node));
    stack_.push_back({.node = plan_.nodes.size() - 1, .is_complement = is_complement});
  }

  Operand pop() {
    const Operand top = stack_.back();
    stack_.pop_back();
    return top;
  }

  SolidPlan plan_ = {};
  std::vector<Operand> stack_ = {};
};

/// The nodes that the root needs; excludes nodes merged into others.
std::vector<bool> needed(const SolidPlan& plan, std::size_t root) {
  std::vector<bool> is_needed(plan.nodes.size(), false);
  is_needed[root] = true;
  for (std::size_t i = root + 1; i-- > 0;) {
    if (!is_needed[i]) continue;
    for (const std::size_t operand : plan.nodes[i].kept) is_needed[operand] = true;
    for (const std::size_t operand : plan.nodes[i].removed) is_needed[operand] = true;
  }
  return is_needed;
}

CsgTree tree_of_operands(const std::vector<std::size_t>& operands, Operation operation,
                         std::vector<std::optional<CsgTree>>& trees) {
  if (operands.empty()) return CsgTree::empty();
  std::vector<CsgNode> nodes;
  for (const std::size_t operand : operands) {
    const std::span<const CsgNode> more = trees[operand]->nodes();
    nodes.insert(nodes.end(), more.begin(), more.end());
    if (operand != operands.front())
      nodes.push_back(CsgNode::inner(operation, static_cast<std::uint32_t>(nodes.size() + 1)));
  }
  return CsgTree(std::move(nodes));
}

}  // namespace

SolidPlan plan_solid(const CsgTree& tree) {
  return Planner().plan(tree);
}

std::vector<std::vector<std::size_t>> levels_of(const SolidPlan& plan) {
  const std::vector<bool> is_needed = needed(plan, plan.root);
  std::vector<std::size_t> height(plan.nodes.size(), 0);
  std::vector<std::vector<std::size_t>> levels;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (!is_needed[i]) continue;
    for (const auto* operands : {&plan.nodes[i].kept, &plan.nodes[i].removed}) {
      for (const std::size_t operand : *operands) height[i] = std::max(height[i], height[operand] + 1);
    }
    if (levels.size() <= height[i]) levels.resize(height[i] + 1);
    levels[height[i]].push_back(i);
  }
  return levels;
}

CsgTree tree_of(const SolidPlan& plan, std::size_t node) {
  const std::vector<bool> is_needed = needed(plan, node);
  std::vector<std::optional<CsgTree>> trees(node + 1);
  for (std::size_t i = 0; i <= node; ++i) {
    if (!is_needed[i]) continue;
    const PlanNode& one = plan.nodes[i];
    if (one.kind == Kind::primitive) {
      trees[i] = CsgTree::leaf(one.primitive);
    } else if (one.kind == Kind::union_of) {
      trees[i] = tree_of_operands(one.kept, Operation::union_of, trees);
    } else {
      trees[i] = tree_of_operands(one.kept, Operation::intersection, trees);
      if (!one.removed.empty()) {
        trees[i] = subtract(*trees[i], tree_of_operands(one.removed, Operation::union_of, trees));
      }
    }
  }
  return std::move(*trees[node]);
}

}  // namespace cloud2csg::brep
