#include "cloud2csg/csg_tree.hpp"

#include <algorithm>
#include <cassert>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

std::uint32_t length_of(std::size_t nodes) {
  return static_cast<std::uint32_t>(nodes);
}

void append(std::vector<CsgNode>& nodes, std::span<const CsgNode> more) {
  nodes.insert(nodes.end(), more.begin(), more.end());
}

template <typename NewName>
CsgTree renamed(const CsgTree& tree, const NewName& new_name) {
  std::vector<CsgNode> nodes(tree.nodes().begin(), tree.nodes().end());
  for (CsgNode& node : nodes) {
    if (node.operation() == Operation::primitive) node = CsgNode::leaf(new_name(node.primitive()));
  }
  return CsgTree(std::move(nodes));
}

/// Precondition: the operation has two children.
CsgTree join(Operation operation, const CsgTree& a, const CsgTree& b) {
  std::vector<CsgNode> nodes;
  nodes.reserve(a.size() + b.size() + 1);
  append(nodes, a.nodes());
  append(nodes, b.nodes());
  nodes.push_back(CsgNode::inner(operation, length_of(nodes.size() + 1)));
  return CsgTree(std::move(nodes));
}

}  // namespace

CsgTree CsgTree::leaf(PrimitiveIndex primitive) {
  return CsgTree(std::vector{CsgNode::leaf(primitive)});
}
CsgTree CsgTree::empty() {
  return CsgTree(std::vector{CsgNode::constant(Operation::empty)});
}
CsgTree CsgTree::full() {
  return CsgTree(std::vector{CsgNode::constant(Operation::full)});
}

void CsgTree::replace(std::size_t root, std::span<const CsgNode> replacement) {
  assert(!replacement.empty());
  assert(replacement.data() + replacement.size() <= nodes_.data() ||
         replacement.data() >= nodes_.data() + nodes_.size());
  const std::size_t old_length = nodes_[root].length();
  const std::size_t first = root + 1 - old_length;
  for (std::size_t i = root + 1; i < nodes_.size(); ++i) {
    const std::size_t length = nodes_[i].length();
    const bool is_ancestor = i + 1 - length <= first;
    if (is_ancestor) {
      nodes_[i] = CsgNode::inner(nodes_[i].operation(), length_of(length - old_length + replacement.size()));
    }
  }
  const auto at = nodes_.begin() + static_cast<std::ptrdiff_t>(first);
  const std::size_t common = std::min(old_length, replacement.size());
  std::copy_n(replacement.begin(), common, at);
  const auto after = at + static_cast<std::ptrdiff_t>(common);
  if (replacement.size() > common) {
    nodes_.insert(after, replacement.begin() + static_cast<std::ptrdiff_t>(common), replacement.end());
  } else {
    nodes_.erase(after, at + static_cast<std::ptrdiff_t>(old_length));
  }
}

CsgTree unite(const CsgTree& a, const CsgTree& b) {
  return join(Operation::union_of, a, b);
}
CsgTree intersect(const CsgTree& a, const CsgTree& b) {
  return join(Operation::intersection, a, b);
}
CsgTree subtract(const CsgTree& a, const CsgTree& b) {
  return join(Operation::difference, a, b);
}

CsgTree complement(const CsgTree& a) {
  std::vector<CsgNode> nodes;
  nodes.reserve(a.size() + 1);
  append(nodes, a.nodes());
  nodes.push_back(CsgNode::inner(Operation::complement, length_of(nodes.size() + 1)));
  return CsgTree(std::move(nodes));
}

CsgTree unite_all(std::span<const CsgTree> trees) {
  if (trees.empty()) return CsgTree::empty();
  std::vector<CsgNode> nodes;
  for (const CsgTree& tree : trees) {
    const bool is_first = nodes.empty();
    append(nodes, tree.nodes());
    if (!is_first) nodes.push_back(CsgNode::inner(Operation::union_of, length_of(nodes.size() + 1)));
  }
  return CsgTree(std::move(nodes));
}

std::size_t depth(const CsgTree& tree) {
  std::vector<std::size_t> depths;
  for (const CsgNode node : tree.nodes()) {
    const int children = arity(node.operation());
    std::size_t deepest = 0;
    for (int child = 0; child < children; ++child) {
      deepest = std::max(deepest, depths.back() + 1);
      depths.pop_back();
    }
    depths.push_back(deepest);
  }
  return depths.back();
}

std::size_t levels(const CsgTree& tree) {
  struct Subtree {
    Operation operation;
    std::size_t levels;
  };
  std::vector<Subtree> stack;
  for (const CsgNode node : tree.nodes()) {
    const Operation operation = node.operation();
    Subtree joined{operation, 0};
    for (int child = arity(operation); child > 0; --child) {
      const Subtree operand = stack.back();
      stack.pop_back();
      // Subtracted solids are listed together as a union, and the first operand may be a difference itself.
      const Operation same = operation == Operation::difference && child == 2 ? Operation::union_of : operation;
      const bool is_listed = operand.operation == same && operation != Operation::complement;
      joined.levels = std::max(joined.levels, operand.levels + (is_listed ? 0 : 1));
    }
    stack.push_back(joined);
  }
  return stack.back().levels;
}

std::size_t leaf_count(const CsgTree& tree) {
  return static_cast<std::size_t>(std::ranges::count(tree.nodes(), Operation::primitive, &CsgNode::operation));
}

std::vector<PrimitiveIndex> primitives_of(const CsgTree& tree) {
  std::vector<PrimitiveIndex> primitives;
  for (const CsgNode node : tree.nodes()) {
    if (node.operation() == Operation::primitive) primitives.push_back(node.primitive());
  }
  std::ranges::sort(primitives);
  primitives.erase(std::unique(primitives.begin(), primitives.end()), primitives.end());
  return primitives;
}

bool is_constant(const CsgTree& tree) {
  return tree.size() == 1 && tree.nodes().front().operation() != Operation::primitive;
}

CsgTree renumber(const CsgTree& tree, std::span<const PrimitiveIndex> new_index) {
  return renamed(tree, [new_index](PrimitiveIndex p) { return new_index[p]; });
}

CsgTree localised(const CsgTree& tree, std::span<const PrimitiveIndex> members) {
  return renamed(tree, [members](PrimitiveIndex p) {
    const auto place = std::ranges::lower_bound(members, p);
    assert(place != members.end() && *place == p);
    return static_cast<PrimitiveIndex>(place - members.begin());
  });
}

bool contains(const CsgTree& tree, const std::vector<bool>& inside_primitive) {
  std::vector<bool> values;
  for (const CsgNode node : tree.nodes()) {
    const int children = arity(node.operation());
    const bool last = children > 0 && values.back();
    const bool first = children > 1 && values[values.size() - 2];
    values.resize(values.size() - static_cast<std::size_t>(children));
    switch (node.operation()) {
      case Operation::primitive:
        values.push_back(inside_primitive[node.primitive()]);
        break;
      case Operation::empty:
        values.push_back(false);
        break;
      case Operation::full:
        values.push_back(true);
        break;
      case Operation::complement:
        values.push_back(!last);
        break;
      case Operation::union_of:
        values.push_back(first || last);
        break;
      case Operation::intersection:
        values.push_back(first && last);
        break;
      case Operation::difference:
        values.push_back(first && !last);
        break;
    }
  }
  return values.back();
}

const CsgTree& tree_of(const Model& model, const std::string& file) {
  if (model.tree) return *model.tree;
  throw Error({.file = file,
               .where = "/tree",
               .expected = "expected a model with a tree, found primitives only",
               .remedy = "extract a tree first, or add a \"tree\" that combines the primitives"});
}

}  // namespace cloud2csg
