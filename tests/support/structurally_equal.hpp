#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg::test {

/// Equality up to commutation and association, exactly: the plain reference beside structural_hash(). A chain of one
/// operation is a node with many operands, whose order does not count but for the first of a difference.
class EqualityClasses {
 public:
  std::uint32_t class_of(const CsgTree& tree) {
    std::vector<Node> stack;
    for (const CsgNode& node : tree.nodes()) {
      Node made{.operation = node.operation(), .operands = {}};
      if (node.operation() == Operation::primitive) made.operands = {node.primitive()};
      const auto children = stack.end() - arity(node.operation());
      for (auto child = children; child != stack.end(); ++child) {
        const bool is_chained = child->operation == made.operation && arity(made.operation) == 2 &&
                                (made.operation != Operation::difference || child == children);
        if (!is_chained) child->operands = {number_of(*child)};
        if (child->operands.size() > made.operands.size()) std::swap(child->operands, made.operands);
        made.operands.insert(made.operands.end(), child->operands.begin(), child->operands.end());
      }
      stack.erase(children, stack.end());
      stack.push_back(std::move(made));
    }
    return number_of(stack.back());
  }

 private:
  struct Node {
    Operation operation;
    std::vector<std::uint32_t> operands;  // classes of the operands; of a primitive its index
  };

  std::uint32_t number_of(Node node) {
    std::sort(node.operands.begin() + (node.operation == Operation::difference ? 1 : 0), node.operands.end());
    const auto next = static_cast<std::uint32_t>(numbers_.size());
    return numbers_.try_emplace({node.operation, node.operands}, next).first->second;
  }

  std::map<std::pair<Operation, std::vector<std::uint32_t>>, std::uint32_t> numbers_;
};

inline bool structurally_equal(const CsgTree& a, const CsgTree& b) {
  EqualityClasses classes;
  return classes.class_of(a) == classes.class_of(b);
}

}  // namespace cloud2csg::test
