#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// Builds a tree in postfix order and folds constants as they come. Constants take no nodes until the end.
class FoldingTree {
 public:
  void leaf(PrimitiveIndex primitive) {
    stack_.push_back({Kind::tree, nodes_.size()});
    nodes_.push_back(CsgNode::leaf(primitive));
  }

  void constant(bool is_full) { stack_.push_back({is_full ? Kind::full : Kind::empty, nodes_.size()}); }

  /// Applies an operation with an arity above 0 to the last operands.
  void apply(Operation operation) {
    if (operation == Operation::complement) {
      invert(stack_.back());
      return;
    }
    const Value second = stack_.back();
    stack_.pop_back();
    Value& first = stack_.back();
    if (first.kind == Kind::tree && second.kind == Kind::tree) {
      nodes_.push_back(CsgNode::inner(operation, static_cast<std::uint32_t>(nodes_.size() - first.begin + 1)));
    } else {
      fold(operation, first, second);
    }
  }

  void replace_last(bool is_full) {
    nodes_.erase(nodes_.begin() + static_cast<std::ptrdiff_t>(stack_.back().begin), nodes_.end());
    stack_.back().kind = is_full ? Kind::full : Kind::empty;
  }

  [[nodiscard]] CsgTree take() {
    if (stack_.back().kind != Kind::tree) return stack_.back().kind == Kind::full ? CsgTree::full() : CsgTree::empty();
    return CsgTree(std::move(nodes_));
  }

 private:
  enum class Kind : std::uint8_t { empty, full, tree };
  struct Value {
    Kind kind;
    std::size_t begin;  ///< where its nodes begin; they end where those of the next value begin
  };

  void invert(Value& value) {
    if (value.kind != Kind::tree) {
      value.kind = value.kind == Kind::full ? Kind::empty : Kind::full;
    } else if (nodes_.back().operation() == Operation::complement) {
      nodes_.pop_back();
    } else {
      const auto length = static_cast<std::uint32_t>(nodes_.size() - value.begin + 1);
      nodes_.push_back(CsgNode::inner(Operation::complement, length));
    }
  }

  /// Folds two operands, at least one of them constant. The result takes the place of the first.
  void fold(Operation operation, Value& first, const Value& second) {
    const auto becomes = [this, &first](Kind kind) {
      nodes_.erase(nodes_.begin() + static_cast<std::ptrdiff_t>(first.begin), nodes_.end());
      first.kind = kind;
    };
    const bool is_union = operation == Operation::union_of;
    const Kind absorbing = is_union ? Kind::full : Kind::empty;
    if (operation == Operation::difference && second.kind != Kind::tree) {
      if (second.kind == Kind::full) becomes(Kind::empty);
    } else if (operation == Operation::difference) {
      if (first.kind == Kind::empty) return becomes(Kind::empty);
      first.kind = Kind::tree;  // all of space less the second
      invert(first);
    } else if (first.kind == absorbing || second.kind == absorbing) {
      becomes(absorbing);
    } else if (first.kind != Kind::tree) {
      first.kind = second.kind;  // the constant had no nodes, so the second's begin where the first's would
    }
  }

  std::vector<CsgNode> nodes_;
  std::vector<Value> stack_;
};

/// Replaces some primitives of a tree by constants and folds it. `constant_of(primitive)` is true for all of space,
/// false for empty and absent for a primitive that stays. O(size).
template <typename ConstantOf>
[[nodiscard]] CsgTree fold_primitives(const CsgTree& tree, const ConstantOf& constant_of) {
  FoldingTree result;
  for (const CsgNode node : tree.nodes()) {
    if (!node.is_leaf()) {
      result.apply(node.operation());
    } else if (node.operation() != Operation::primitive) {
      result.constant(node.operation() == Operation::full);
    } else if (const std::optional<bool> constant = constant_of(node.primitive())) {
      result.constant(*constant);
    } else {
      result.leaf(node.primitive());
    }
  }
  return result.take();
}

}  // namespace cloud2csg
