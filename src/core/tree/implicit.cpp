#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "cloud2csg/csg_tree.hpp"
#include "core/primitive/sampled_field.hpp"
#include "core/tree/taken.hpp"

namespace cloud2csg {
namespace {

/// Points a block, so that columns of doubles stay in the second-level cache.
constexpr std::size_t k_block = 1024;
/// Most elements in all columns together. A very deep tree gets smaller blocks.
constexpr std::size_t k_column_budget = std::size_t{1} << 22U;

/// A value and the primitive that has it. `signed_index` is (index + 1) times the sign of the signed rank. Comparing
/// (value, signed_index) compares signed ranks; see implicit_gradient() in the header.
struct Selected {
  double value;
  std::int32_t signed_index;
  std::int32_t sign;  ///< 1 where the value is +f, -1 where it is -f

  friend bool operator<(const Selected& a, const Selected& b) {
    return a.value < b.value || (a.value == b.value && a.signed_index < b.signed_index);
  }
  friend Selected operator-(const Selected& a) { return {-a.value, -a.signed_index, -a.sign}; }
};

constexpr std::int32_t k_no_primitive = std::numeric_limits<std::int32_t>::max();
constexpr double k_infinity = std::numeric_limits<double>::infinity();

template <typename Element>
Element leaf_value(double distance, PrimitiveIndex primitive);
template <>
double leaf_value(double distance, PrimitiveIndex /*primitive*/) {
  return distance;
}
template <>
Selected leaf_value(double distance, PrimitiveIndex primitive) {
  const auto index = static_cast<std::int32_t>(primitive + 1);
  return {distance, distance < 0 ? -index : index, 1};
}

template <typename Element>
Element empty_value();
template <>
double empty_value() {
  return k_infinity;
}
template <>
Selected empty_value() {
  return {k_infinity, k_no_primitive, 1};
}

/// Evaluates a tree node by node over columns. Element is double, or Selected where the chosen primitive matters.
template <typename Element>
class ColumnEvaluator {
 public:
  ColumnEvaluator(const CsgTree& tree, const PrimitiveSet& primitives)
      : tree_(tree), primitives_(primitives), used_(primitives_of(tree)) {
    column_of_.resize(used_.empty() ? 0 : used_.back() + 1);
    for (std::size_t i = 0; i < used_.size(); ++i) column_of_[used_[i]] = i;
    const std::size_t columns = used_.size() + most_scratch_columns() + 1;
    block_ = std::clamp<std::size_t>(k_column_budget / columns, 1, k_block);
    leaves_.resize(used_.size() * block_);
    distances_.resize(block_);
  }

  [[nodiscard]] std::size_t block() const { return block_; }

  /// The tree's values at up to block() points.
  std::span<const Element> operator()(PointsView points) {
    count_ = points.size();
    for (std::size_t i = 0; i < used_.size(); ++i) {
      const std::span<double> distances = std::span(distances_).first(count_);
      evaluate_distance(primitives_[used_[i]], points, distances);
      Element* column = leaves_.data() + i * block_;
      for (std::size_t p = 0; p < count_; ++p) {
        column[p] = leaf_value<Element>(distances[p], used_[i]);
      }
    }
    stack_.clear();
    scratch_in_use_ = 0;
    for (const CsgNode node : tree_.nodes()) apply(node);
    return {stack_.back().column, count_};
  }

 private:
  struct Operand {
    const Element* column;
    bool is_scratch;
  };

  /// Leaves are used in place. Every other value on the stack owns a scratch column.
  [[nodiscard]] std::size_t most_scratch_columns() const {
    std::vector<bool> owns;
    std::size_t in_use = 0;
    std::size_t most = 0;
    for (const CsgNode node : tree_.nodes()) {
      for (int child = arity(node.operation()); child > 0; --child) {
        in_use -= owns.back() ? 1 : 0;
        owns.pop_back();
      }
      owns.push_back(node.operation() != Operation::primitive);
      in_use += owns.back() ? 1 : 0;
      most = std::max(most, in_use);
    }
    return most;
  }

  const Element* pop() {
    const Operand top = stack_.back();
    stack_.pop_back();
    if (top.is_scratch) --scratch_in_use_;
    return top.column;
  }

  /// Scratch columns form a stack, so the first free one may be an operand. Element by element that is harmless.
  Element* push() {
    if (scratch_in_use_ == scratch_.size()) scratch_.emplace_back(block_);
    Element* column = scratch_[scratch_in_use_++].data();
    stack_.push_back({column, true});
    return column;
  }

  void apply(CsgNode node) {
    switch (node.operation()) {
      case Operation::primitive:
        stack_.push_back({leaves_.data() + column_of_[node.primitive()] * block_, false});
        break;
      case Operation::empty:
        std::fill_n(push(), count_, empty_value<Element>());
        break;
      case Operation::full:
        std::fill_n(push(), count_, -empty_value<Element>());
        break;
      case Operation::complement: {
        const Element* a = pop();
        std::transform(a, a + count_, push(), [](const Element& x) { return -x; });
        break;
      }
      case Operation::union_of:
        binary([](const Element& x, const Element& y) { return std::min(x, y); });
        break;
      case Operation::intersection:
        binary([](const Element& x, const Element& y) { return std::max(x, y); });
        break;
      case Operation::difference:
        binary([](const Element& x, const Element& y) { return std::max<Element>(x, -y); });
        break;
    }
  }

  template <typename Combine>
  void binary(Combine combine) {
    const Element* b = pop();
    const Element* a = pop();
    std::transform(a, a + count_, b, push(), combine);
  }

  const CsgTree& tree_;
  const PrimitiveSet& primitives_;
  std::vector<PrimitiveIndex> used_;
  std::vector<std::size_t> column_of_;  ///< by primitive: its position in used_
  std::size_t block_ = 0;
  std::size_t count_ = 0;
  std::vector<Element> leaves_;  ///< a column of block_ elements for each used primitive
  std::vector<double> distances_;
  std::vector<std::vector<Element>> scratch_;
  std::size_t scratch_in_use_ = 0;
  std::vector<Operand> stack_;
};

template <typename Element, typename Consume>
void for_each_value(const CsgTree& tree, const PrimitiveSet& primitives, PointsView points, Consume consume) {
  ColumnEvaluator<Element> evaluate(tree, primitives);
  for (std::size_t begin = 0; begin < points.size(); begin += evaluate.block()) {
    const std::size_t count = std::min(evaluate.block(), points.size() - begin);
    consume(begin, evaluate(points.subview(begin, count)));
  }
}

}  // namespace

std::vector<Taken> taken_by_primitive(const CsgTree& tree, const PrimitiveSet& primitives, PointsView points) {
  std::vector<Taken> taken(primitives.size());
  for_each_value<Selected>(tree, primitives, points, [&](std::size_t begin, std::span<const Selected> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::int32_t index = std::abs(values[i].signed_index);
      if (index == k_no_primitive) continue;
      Taken& of_primitive = taken[static_cast<std::size_t>(index - 1)];
      of_primitive.points.push_back(begin + i);
      of_primitive.signs.push_back(values[i].sign);
    }
  });
  return taken;
}

std::vector<double> implicit_value(const CsgTree& tree, const PrimitiveSet& primitives, PointsView points) {
  std::vector<double> result(points.size());
  for_each_value<double>(tree, primitives, points, [&](std::size_t begin, std::span<const double> values) {
    std::ranges::copy(values, result.begin() + static_cast<std::ptrdiff_t>(begin));
  });
  return result;
}

Points implicit_gradient(const CsgTree& tree, const PrimitiveSet& primitives, PointsView points) {
  Points result(points.size());
  const std::vector<Taken> taken = taken_by_primitive(tree, primitives, points);
  for (std::size_t p = 0; p < taken.size(); ++p) {
    if (taken[p].points.empty()) continue;
    Points gathered(taken[p].points.size());
    for (std::size_t i = 0; i < gathered.size(); ++i) gathered.set(i, points[taken[p].points[i]]);
    const SampledField field = sample_field(primitives[p], gathered);
    for (std::size_t i = 0; i < gathered.size(); ++i) {
      result.set(taken[p].points[i], taken[p].signs[i] * field.slopes[i]);
    }
  }
  return result;
}

}  // namespace cloud2csg
