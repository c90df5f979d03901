#include "shape/mesh/interval_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "core/fields/lipschitz.hpp"

namespace cloud2csg {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// A subtree that has been pruned already: from `begin` to the next operand's begin or the end of the output.
struct Operand {
  std::size_t begin;
  Interval value;
};

Interval negated(Interval a) {
  return {.low = -a.high, .high = -a.low};
}

class Pruner {
 public:
  explicit Pruner(std::span<const Interval> primitive_values) : primitive_values_(primitive_values) {}

  PrunedTree prune(std::span<const CsgNode> tree) {
    for (const CsgNode& node : tree) add(node);
    return {.nodes = std::move(output_), .value = stack_.back().value};
  }

 private:
  void add(const CsgNode& node) {
    switch (node.operation()) {
      case Operation::primitive:
        return add_leaf(node, primitive_values_[node.primitive()]);
      case Operation::empty:
        return add_leaf(node, {.low = k_infinity, .high = k_infinity});
      case Operation::full:
        return add_leaf(node, {.low = -k_infinity, .high = -k_infinity});
      case Operation::complement:
        stack_.back().value = negated(stack_.back().value);
        return add_inner(node.operation());
      case Operation::union_of:
        return add_union();
      case Operation::intersection:
        return add_intersection(false);
      case Operation::difference:
        return add_intersection(true);
    }
  }

  void add_leaf(const CsgNode& node, Interval value) {
    stack_.push_back({.begin = output_.size(), .value = value});
    output_.push_back(node);
  }

  void add_inner(Operation operation) {
    const std::size_t length = output_.size() - stack_.back().begin + 1;
    output_.push_back(CsgNode::inner(operation, static_cast<std::uint32_t>(length)));
  }

  /// min(a, b)
  void add_union() {
    const Operand b = stack_.back();
    stack_.pop_back();
    Operand& a = stack_.back();
    if (a.value.high < b.value.low) return drop_second(b);
    if (b.value.high < a.value.low) return drop_first(b);
    a.value = {.low = std::min(a.value.low, b.value.low), .high = std::min(a.value.high, b.value.high)};
    add_inner(Operation::union_of);
  }

  /// max(a, b), or max(a, -b)
  void add_intersection(bool is_difference) {
    const Operand b = stack_.back();
    const Interval b_value = is_difference ? negated(b.value) : b.value;
    stack_.pop_back();
    Operand& a = stack_.back();
    if (a.value.low > b_value.high) return drop_second(b);
    if (b_value.low > a.value.high) {
      drop_first({.begin = b.begin, .value = b_value});
      if (is_difference) add_inner(Operation::complement);
      return;
    }
    a.value = {.low = std::max(a.value.low, b_value.low), .high = std::max(a.value.high, b_value.high)};
    add_inner(is_difference ? Operation::difference : Operation::intersection);
  }

  void drop_second(const Operand& b) { output_.erase(at(b.begin), output_.end()); }

  void drop_first(const Operand& b) {
    Operand& a = stack_.back();
    output_.erase(at(a.begin), at(b.begin));
    a.value = b.value;
  }

  std::vector<CsgNode>::iterator at(std::size_t index) { return output_.begin() + static_cast<std::ptrdiff_t>(index); }

  std::span<const Interval> primitive_values_;
  std::vector<Operand> stack_ = {};
  std::vector<CsgNode> output_ = {};
};

}  // namespace

Interval value_near(const Primitive& primitive, double value, double radius) {
  if (std::isnan(value)) return {.low = -k_infinity, .high = k_infinity};
  double change = lipschitz_bound(primitive) * radius;
  // The displacement itself never changes by more than 2, however high its frequency.
  if (primitive.displacement && !std::holds_alternative<Expression>(primitive.shape)) {
    change = std::min(change, radius + 2.0);
  }
  return {.low = value - change, .high = value + change};
}

PrunedTree prune(std::span<const CsgNode> tree, std::span<const Interval> primitive_values) {
  return Pruner(primitive_values).prune(tree);
}

}  // namespace cloud2csg
