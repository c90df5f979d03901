#include "cells/reduced_function.hpp"

#include <algorithm>
#include <map>

namespace cloud2csg {
namespace {

/// Whether two variables are equal in all rows, or each other's complement in all rows.
bool are_interchangeable(const PartialFunction& function, PrimitiveIndex a, PrimitiveIndex b) {
  const bool differ = function.is_true(0, a) != function.is_true(0, b);
  for (std::size_t row = 1; row < function.rows(); ++row) {
    if ((function.is_true(row, a) != function.is_true(row, b)) != differ) return false;
  }
  return true;
}

bool is_constant(const PartialFunction& function, PrimitiveIndex variable) {
  for (std::size_t row = 1; row < function.rows(); ++row) {
    if (function.is_true(row, variable) != function.is_true(0, variable)) return false;
  }
  return true;
}

}  // namespace

ReducedFunction reduce(const PartialFunction& function) {
  ReducedFunction reduced;
  for (PrimitiveIndex v = 0; v < function.variables(); ++v) {
    const auto same = [&function, v](PrimitiveIndex other) { return are_interchangeable(function, v, other); };
    if (is_constant(function, v) || std::ranges::any_of(reduced.variables, same)) continue;
    reduced.variables.push_back(v);
  }
  std::map<std::vector<bool>, bool> rows;
  for (std::size_t row = 0; row < function.rows(); ++row) {
    std::vector<bool> assignment(reduced.variables.size());
    for (std::size_t i = 0; i < assignment.size(); ++i) assignment[i] = function.is_true(row, reduced.variables[i]);
    rows.emplace(std::move(assignment), function.value(row));
  }
  for (const auto& [assignment, value] : rows) {
    reduced.assignments.push_back(assignment);
    reduced.values.push_back(value);
  }
  return reduced;
}

std::vector<std::vector<RowPair>> neighbours(const ReducedFunction& function) {
  std::vector<std::vector<RowPair>> pairs(function.variables.size());
  for (std::size_t row = 0; row < function.assignments.size(); ++row) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      std::vector<bool> assignment = function.assignments[row];
      if (assignment[i]) continue;
      assignment[i] = true;
      const auto place = std::ranges::lower_bound(function.assignments, assignment);
      if (place == function.assignments.end() || *place != assignment) continue;
      pairs[i].push_back(
          {.row_without = row, .row_with = static_cast<std::size_t>(place - function.assignments.begin())});
    }
  }
  return pairs;
}

}  // namespace cloud2csg
