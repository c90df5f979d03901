#include "view/report/shown_tree.hpp"

#include <algorithm>

namespace cloud2csg {
namespace {

/// Collects the operands of a chain of one operation from left to right.
void collect_chain(const CsgTree& tree, std::size_t root, Operation operation, std::vector<std::size_t>& operands) {
  std::vector<std::size_t> open{root};
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    if (tree.nodes()[node].operation() != operation) {
      operands.push_back(node);
      continue;
    }
    open.push_back(tree.second_child(node));
    open.push_back(tree.first_child(node));
  }
}

/// a - b - (c | d): a, b, c, d.
std::vector<std::size_t> operands_of_difference(const CsgTree& tree, std::size_t root) {
  std::vector<std::size_t> subtracted;  // from right to left
  std::size_t node = root;
  while (tree.nodes()[node].operation() == Operation::difference) {
    subtracted.push_back(tree.second_child(node));
    node = tree.first_child(node);
  }
  std::vector<std::size_t> operands{node};
  for (std::size_t k = subtracted.size(); k-- > 0;) {
    collect_chain(tree, subtracted[k], Operation::union_of, operands);
  }
  return operands;
}

std::vector<std::size_t> operands_of(const CsgTree& tree, std::size_t root) {
  const Operation operation = tree.nodes()[root].operation();
  std::vector<std::size_t> operands;
  if (operation == Operation::difference) return operands_of_difference(tree, root);
  if (operation == Operation::complement) return {tree.second_child(root)};
  if (arity(operation) == 2) collect_chain(tree, root, operation, operands);
  return operands;
}

struct Open {
  std::size_t root, parent, depth;
};

}  // namespace

std::vector<ShownNode> shown_tree(const CsgTree& tree) {
  std::vector<ShownNode> nodes;
  std::vector<Open> open{{.root = tree.root(), .parent = 0, .depth = 0}};
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const CsgNode node = tree.nodes()[next.root];
    const std::size_t index = nodes.size();
    if (index > 0) nodes[next.parent].children.push_back(index);
    nodes.push_back({.operation = node.operation(),
                     .primitive = node.operation() == Operation::primitive ? node.primitive() : 0,
                     .children = {},
                     .parent = next.parent,
                     .depth = next.depth,
                     .root = next.root});
    const std::vector<std::size_t> operands = operands_of(tree, next.root);
    for (std::size_t k = operands.size(); k-- > 0;) {
      open.push_back({.root = operands[k], .parent = index, .depth = next.depth + 1});
    }
  }
  return nodes;
}

}  // namespace cloud2csg
