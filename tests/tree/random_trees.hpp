#pragma once

#include <rapidcheck.h>

#include <cstdint>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

/// Random trees and primitive sets for the tests of all stages that work on trees.
namespace cloud2csg::test {

/// Unit spheres along the x axis, one unit apart, with ids p0, p1...
inline PrimitiveSet sphere_row(std::size_t count) {
  PrimitiveSet primitives;
  for (std::size_t i = 0; i < count; ++i) {
    primitives.push_back({.id = "p", .shape = Sphere{.radius = 1.0}});
    primitives.back().id += std::to_string(i);
    primitives.back().pose.position.x() = static_cast<double>(i);
  }
  return primitives;
}

/// The same, with ids a to z.
inline PrimitiveSet letters() {
  PrimitiveSet primitives = sphere_row(26);
  for (std::size_t i = 0; i < primitives.size(); ++i) primitives[i].id = std::string(1, static_cast<char>('a' + i));
  return primitives;
}

/// Runs a small stack program: 0 .. 3 push a leaf, 4 a constant, 5 .. 9 apply an operation. What is left is joined.
inline CsgTree tree_of_program(const std::vector<std::pair<int, std::uint32_t>>& program) {
  std::vector<CsgTree> stack;
  const auto pop = [&stack] {
    CsgTree top = std::move(stack.back());
    stack.pop_back();
    return top;
  };
  for (const auto& [code, primitive] : program) {
    if (code == 4) {
      stack.push_back(primitive % 2 == 0 ? CsgTree::empty() : CsgTree::full());
    } else if (code == 5 && !stack.empty()) {
      stack.push_back(complement(pop()));
    } else if (code > 5 && stack.size() > 1) {
      const CsgTree b = pop();
      const CsgTree a = pop();
      stack.push_back(code <= 7 ? unite(a, b) : code == 8 ? intersect(a, b) : subtract(a, b));
    } else {
      stack.push_back(CsgTree::leaf(primitive));
    }
  }
  CsgTree tree = stack.empty() ? CsgTree::empty() : pop();
  while (!stack.empty()) tree = stack.size() % 2 == 0 ? subtract(pop(), tree) : intersect(pop(), tree);
  return tree;
}

/// Trees of all operations over `primitives` primitives, shrinking towards small ones.
inline rc::Gen<CsgTree> any_tree(std::uint32_t primitives) {
  const auto step = rc::gen::pair(rc::gen::inRange(0, 10), rc::gen::inRange<std::uint32_t>(0, primitives));
  return rc::gen::map(rc::gen::container<std::vector<std::pair<int, std::uint32_t>>>(step), tree_of_program);
}

/// Membership for every combination of being inside of 0 .. primitives - 1: entry m has bit p of m for primitive p.
inline std::vector<bool> truth_table(const CsgTree& tree, std::size_t primitives) {
  std::vector<bool> table;
  std::vector<bool> inside(primitives);
  for (std::size_t mask = 0; mask < std::size_t{1} << primitives; ++mask) {
    for (std::size_t p = 0; p < primitives; ++p) inside[p] = ((mask >> p) & 1U) != 0;
    table.push_back(contains(tree, inside));
  }
  return table;
}

/// Whether lengths and arities fit together, as CsgTree promises.
inline bool is_well_formed(const CsgTree& tree) {
  std::vector<std::size_t> lengths;
  for (const CsgNode node : tree.nodes()) {
    std::size_t length = 1;
    for (int child = arity(node.operation()); child > 0; --child) {
      if (lengths.empty()) return false;
      length += lengths.back();
      lengths.pop_back();
    }
    if (node.length() != length) return false;
    lengths.push_back(length);
  }
  return lengths.size() == 1;
}

}  // namespace cloud2csg::test

namespace rc {

/// Lets properties take trees as arguments.
template <>
struct Arbitrary<cloud2csg::CsgTree> {
  static Gen<cloud2csg::CsgTree> arbitrary() { return cloud2csg::test::any_tree(6); }
};

}  // namespace rc

namespace cloud2csg {

inline void showValue(const CsgTree& tree, std::ostream& out) {  // NOLINT(readability-identifier-naming)
  std::size_t primitives = 0;
  for (const PrimitiveIndex p : primitives_of(tree)) primitives = p + std::size_t{1};
  out << to_text(tree, test::sphere_row(primitives));
}

}  // namespace cloud2csg
