#include "paper/evolve/operators.hpp"

#include "paper/evolve/random_tree.hpp"

namespace cloud2csg {
namespace {

/// Edges from the root down to a node: the number of its ancestors.
int level_of(const CsgTree& tree, std::size_t node) {
  int level = 0;
  for (std::size_t above = node + 1; above < tree.size(); ++above) {
    if (above + 1 - tree.nodes()[above].length() <= node) ++level;
  }
  return level;
}

CsgTree with_subtree(const CsgTree& tree, std::size_t node, std::span<const CsgNode> replacement, int height_limit) {
  CsgTree child = tree;
  child.replace(node, replacement);
  return depth(child) <= static_cast<std::size_t>(height_limit) ? child : tree;
}

}  // namespace

Children crossover(const CsgTree& a, const CsgTree& b, int height_limit, RandomStream& random) {
  const std::size_t at_a = random.below(a.size());
  const std::size_t at_b = random.below(b.size());
  return {with_subtree(a, at_a, b.subtree(at_b), height_limit), with_subtree(b, at_b, a.subtree(at_a), height_limit)};
}

CsgTree mutate_subtree(const CsgTree& tree, std::size_t primitives, int height_limit, RandomStream& random) {
  const std::size_t node = random.below(tree.size());
  const CsgTree fresh = random_tree(primitives, height_limit - level_of(tree, node), random);
  CsgTree child = tree;
  child.replace(node, fresh.nodes());
  return child;
}

}  // namespace cloud2csg
