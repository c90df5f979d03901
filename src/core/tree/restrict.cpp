#include "cloud2csg/advanced/restrict.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/tree/folding.hpp"

namespace cloud2csg {
namespace {

enum class Step { keep, invert, forget };

/// What a parent does with a node's value when its other child, if any, is constant.
Step step_to_parent(Operation parent, bool is_first_child, bool is_sibling_full) {
  switch (parent) {
    case Operation::complement:
      return Step::invert;
    case Operation::union_of:
      return is_sibling_full ? Step::forget : Step::keep;
    case Operation::intersection:
      return is_sibling_full ? Step::keep : Step::forget;
    case Operation::difference:
      if (is_first_child) return is_sibling_full ? Step::forget : Step::keep;
      return is_sibling_full ? Step::invert : Step::forget;
    default:
      assert(false);
      return Step::keep;
  }
}

/// By node: whether its subtree is all of space when every primitive is empty.
std::vector<bool> values_without_primitives(const CsgTree& tree) {
  const std::span<const CsgNode> nodes = tree.nodes();
  std::vector<bool> full(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Operation operation = nodes[i].operation();
    if (arity(operation) == 0) {
      full[i] = operation == Operation::full;
      continue;
    }
    const bool last = full[tree.second_child(i)];
    const bool first = arity(operation) == 2 && full[tree.first_child(i)];
    full[i] = operation == Operation::complement     ? !last
              : operation == Operation::union_of     ? first || last
              : operation == Operation::intersection ? first && last
                                                     : first && !last;
  }
  return full;
}

}  // namespace

CsgTree restrict_to(const CsgTree& tree, std::span<const PrimitiveIndex> kept) {
  std::vector<bool> is_kept;
  for (const PrimitiveIndex p : kept) {
    if (p >= is_kept.size()) is_kept.resize(p + std::size_t{1});
    is_kept[p] = true;
  }
  return fold_primitives(tree, [&](PrimitiveIndex p) {
    return p < is_kept.size() && is_kept[p] ? std::nullopt : std::optional(/*is_full=*/false);
  });
}

TreeRestriction::TreeRestriction(const CsgTree& tree) : tree_(tree), is_full_(values_without_primitives(tree)) {
  link_parents();
  measure_paths();
  build_shallowest();
  for (NodeIndex i = 0; i < tree_.size(); ++i) {
    if (tree_.nodes()[i].operation() == Operation::primitive) leaves_.push_back(i);
  }
  const auto primitive_of = [this](NodeIndex i) { return tree_.nodes()[i].primitive(); };
  std::stable_sort(leaves_.begin(), leaves_.end(),
                   [&](NodeIndex a, NodeIndex b) { return primitive_of(a) < primitive_of(b); });
  const std::size_t primitives = leaves_.empty() ? 0 : primitive_of(leaves_.back()) + std::size_t{1};
  leaf_begin_.assign(primitives + 1, 0);
  for (const NodeIndex leaf : leaves_) ++leaf_begin_[primitive_of(leaf) + std::size_t{1}];
  for (std::size_t p = 0; p < primitives; ++p) leaf_begin_[p + 1] += leaf_begin_[p];
}

void TreeRestriction::link_parents() {
  parent_.resize(tree_.size());
  parent_.back() = static_cast<NodeIndex>(tree_.root());
  for (std::size_t i = 0; i < tree_.size(); ++i) {
    const int children = arity(tree_.nodes()[i].operation());
    if (children > 0) parent_[tree_.second_child(i)] = static_cast<NodeIndex>(i);
    if (children > 1) parent_[tree_.first_child(i)] = static_cast<NodeIndex>(i);
  }
}

void TreeRestriction::measure_paths() {
  depth_.assign(tree_.size(), 0);
  inversions_.assign(tree_.size(), 0);
  forgetting_depth_.assign(tree_.size(), 0);
  for (std::size_t i = tree_.root(); i-- > 0;) {  // parents come after their children
    const NodeIndex parent = parent_[i];
    const Operation operation = tree_.nodes()[parent].operation();
    const bool is_first = arity(operation) == 2 && tree_.first_child(parent) == i;
    const bool has_full_sibling =
        arity(operation) == 2 && is_full_[is_first ? tree_.second_child(parent) : tree_.first_child(parent)];
    const Step step = step_to_parent(operation, is_first, has_full_sibling);
    depth_[i] = depth_[parent] + 1;
    inversions_[i] = inversions_[parent] + (step == Step::invert ? 1 : 0);
    forgetting_depth_[i] = step == Step::forget ? depth_[i] : forgetting_depth_[parent];
  }
}

void TreeRestriction::build_shallowest() {
  std::vector<NodeIndex> row(tree_.size());
  for (NodeIndex i = 0; i < row.size(); ++i) row[i] = i;
  shallowest_.push_back(std::move(row));
  for (std::size_t width = 1; 2 * width <= tree_.size(); width *= 2) {
    const std::vector<NodeIndex>& narrow = shallowest_.back();
    std::vector<NodeIndex> wide(tree_.size() + 1 - 2 * width);
    for (std::size_t i = 0; i < wide.size(); ++i) {
      wide[i] = depth_[narrow[i]] <= depth_[narrow[i + width]] ? narrow[i] : narrow[i + width];
    }
    shallowest_.push_back(std::move(wide));
  }
}

/// Precondition: leaves a < b. The shallowest node between them is the child of the common ancestor that holds a.
TreeRestriction::NodeIndex TreeRestriction::common_ancestor(NodeIndex a, NodeIndex b) const {
  const auto bits = static_cast<std::size_t>(std::bit_width(b - a));
  const std::vector<NodeIndex>& row = shallowest_[bits - 1];
  const NodeIndex left = row[a];
  const NodeIndex right = row[b - (std::size_t{1} << bits) / 2];
  return parent_[depth_[left] <= depth_[right] ? left : right];
}

/// The child of `ancestor` whose subtree holds `node`. Precondition: `ancestor` is no complement.
TreeRestriction::NodeIndex TreeRestriction::child_towards(NodeIndex ancestor, NodeIndex node) const {
  const std::size_t first = tree_.first_child(ancestor);
  return static_cast<NodeIndex>(node <= first ? first : tree_.second_child(ancestor));
}

std::vector<TreeRestriction::NodeIndex> TreeRestriction::leaves_of(std::span<const PrimitiveIndex> kept) const {
  std::vector<NodeIndex> found;
  for (const PrimitiveIndex p : kept) {
    if (p + std::size_t{1} >= leaf_begin_.size()) continue;
    found.insert(found.end(), leaves_.begin() + static_cast<std::ptrdiff_t>(leaf_begin_[p]),
                 leaves_.begin() + static_cast<std::ptrdiff_t>(leaf_begin_[p + 1]));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Writes the kept leaves and their common ancestors in postfix order. A path between two of them has only constants
/// beside it, so it keeps, inverts or forgets the value from below.
class TreeRestriction::Builder {
 public:
  explicit Builder(const TreeRestriction& index) : index_(index) {}

  void leaf(NodeIndex node) {
    at_ = node;
    result_.leaf(index_.tree_.nodes()[node].primitive());
  }

  /// Lifts the last value to the first child of `ancestor`. The second child follows.
  void open(NodeIndex ancestor) {
    lift(index_.child_towards(ancestor, at_));
    open_.push_back(ancestor);
  }

  /// Closes all open nodes deeper than `depth`.
  void close(std::uint32_t depth) {
    while (!open_.empty() && index_.depth_[open_.back()] > depth) close_last();
  }

  [[nodiscard]] CsgTree finish() {
    while (!open_.empty()) close_last();
    lift(static_cast<NodeIndex>(index_.tree_.root()));
    return result_.take();
  }

 private:
  void close_last() {
    const NodeIndex ancestor = open_.back();
    open_.pop_back();
    lift(index_.child_towards(ancestor, at_));
    result_.apply(index_.tree_.nodes()[ancestor].operation());
    at_ = ancestor;
  }

  /// Lifts the last value from node at_ to an ancestor, or keeps it at at_.
  void lift(NodeIndex ancestor) {
    if (index_.forgetting_depth_[at_] > index_.depth_[ancestor]) {
      result_.replace_last(index_.is_full_[ancestor]);
    } else if ((index_.inversions_[at_] - index_.inversions_[ancestor]) % 2 == 1) {
      result_.apply(Operation::complement);
    }
    at_ = ancestor;
  }

  const TreeRestriction& index_;
  FoldingTree result_;
  NodeIndex at_ = 0;             ///< node of the last value
  std::vector<NodeIndex> open_;  ///< nodes whose first child is written; each below the one before
};

CsgTree TreeRestriction::restrict_to(std::span<const PrimitiveIndex> kept) const {
  const std::vector<NodeIndex> leaves = leaves_of(kept);
  if (leaves.empty()) return is_full_.back() ? CsgTree::full() : CsgTree::empty();
  Builder builder(*this);
  builder.leaf(leaves.front());
  for (std::size_t i = 1; i < leaves.size(); ++i) {
    const NodeIndex ancestor = common_ancestor(leaves[i - 1], leaves[i]);
    builder.close(depth_[ancestor]);
    builder.open(ancestor);
    builder.leaf(leaves[i]);
  }
  return builder.finish();
}

}  // namespace cloud2csg
