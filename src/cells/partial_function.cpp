#include <algorithm>

#include "cloud2csg/advanced/formula.hpp"

namespace cloud2csg {
namespace {

using Column = std::vector<std::uint64_t>;

Column full_column(const PartialFunction& function) {
  Column column(function.words(), ~std::uint64_t{0});
  if (function.rows() % 64 != 0) column.back() = (std::uint64_t{1} << (function.rows() % 64)) - 1;
  return column;
}

template <class Combine>
void combine(Column& first, const Column& second, Combine&& by) {
  for (std::size_t w = 0; w < first.size(); ++w) first[w] = by(first[w], second[w]);
}

void apply(Operation operation, Column& first, const Column& second) {
  switch (operation) {
    case Operation::union_of:
      return combine(first, second, [](std::uint64_t a, std::uint64_t b) { return a | b; });
    case Operation::intersection:
      return combine(first, second, [](std::uint64_t a, std::uint64_t b) { return a & b; });
    default:
      return combine(first, second, [](std::uint64_t a, std::uint64_t b) { return a & ~b; });
  }
}

}  // namespace

void PartialFunction::add(std::span<const PrimitiveIndex> true_variables, bool value) {
  const std::size_t word = rows_ / 64;
  const std::uint64_t bit = std::uint64_t{1} << (rows_ % 64);
  if (rows_ % 64 == 0) {
    for (Column& column : columns_) column.push_back(0);
    values_.push_back(0);
  }
  for (const PrimitiveIndex variable : true_variables) columns_[variable][word] |= bit;
  if (value) values_[word] |= bit;
  ++rows_;
}

std::vector<std::uint64_t> evaluate(const CsgTree& formula, const PartialFunction& function) {
  const Column all = full_column(function);
  std::vector<Column> stack;
  for (const CsgNode node : formula.nodes()) {
    switch (node.operation()) {
      case Operation::primitive: {
        const std::span<const std::uint64_t> column = function.column(node.primitive());
        stack.emplace_back(column.begin(), column.end());
        break;
      }
      case Operation::empty:
        stack.emplace_back(all.size(), 0);
        break;
      case Operation::full:
        stack.push_back(all);
        break;
      case Operation::complement:
        combine(stack.back(), all, [](std::uint64_t a, std::uint64_t b) { return ~a & b; });
        break;
      default: {
        const Column second = std::move(stack.back());
        stack.pop_back();
        apply(node.operation(), stack.back(), second);
      }
    }
  }
  return stack.back();
}

bool agrees(const CsgTree& formula, const PartialFunction& function) {
  return std::ranges::equal(evaluate(formula, function), function.values());
}

}  // namespace cloud2csg
