#include <algorithm>
#include <cstdint>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "core/tree/interner.hpp"

/// Equality up to commutation and association. A **chain** is a maximal run of nodes of one operation: for unions and
/// intersections through both children, for differences through the first child, ((a - b) - c) - d. Its **operands**
/// are the subtrees that hang off it. Their order does not count, but for the first of a difference.
namespace cloud2csg {
namespace {

/// Whether a child belongs to its parent's chain.
bool continues_chain(Operation parent, Operation child, bool is_first) {
  return parent == child && arity(parent) == 2 && (parent != Operation::difference || is_first);
}

std::uint64_t salted(std::uint64_t value, Operation operation) {
  return mix(value ^ (static_cast<std::uint64_t>(operation) << 56U));
}

/// A node's hash and, for binary nodes, the sums that its chain hands up. Sums do not depend on the order.
struct ChainHash {
  std::uint64_t hash = 0;
  std::uint64_t operands = 0;  ///< sum over the operands; in a difference, over the subtracted ones
  std::uint64_t base = 0;      ///< in a difference: hash of the first operand
};

ChainHash hash_of_binary(Operation operation, const ChainHash& first, bool joins_first, const ChainHash& second,
                         bool joins_second) {
  const auto contribution = [operation](const ChainHash& child) { return salted(mix(child.hash), operation); };
  ChainHash result;
  if (operation == Operation::difference) {
    result.base = joins_first ? first.base : first.hash;
    result.operands = (joins_first ? first.operands : 0) + contribution(second);
  } else {
    result.operands =
        (joins_first ? first.operands : contribution(first)) + (joins_second ? second.operands : contribution(second));
  }
  result.hash = salted(mix(result.base) + mix(result.operands), operation);
  return result;
}

}  // namespace

std::vector<std::uint64_t> structural_hashes(const CsgTree& tree) {
  std::vector<ChainHash> chains(tree.size());
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const CsgNode node = tree.nodes()[i];
    const Operation operation = node.operation();
    if (operation == Operation::primitive) {
      chains[i].hash = salted(mix(node.primitive()), operation);
    } else if (node.is_leaf()) {
      chains[i].hash = salted(0, operation);
    } else if (operation == Operation::complement) {
      chains[i].hash = salted(mix(chains[i - 1].hash), operation);
    } else {
      const std::size_t first = tree.first_child(i);
      const std::size_t second = tree.second_child(i);
      chains[i] =
          hash_of_binary(operation, chains[first], continues_chain(operation, tree.nodes()[first].operation(), true),
                         chains[second], continues_chain(operation, tree.nodes()[second].operation(), false));
    }
  }
  std::vector<std::uint64_t> hashes(tree.size());
  std::ranges::transform(chains, hashes.begin(), &ChainHash::hash);
  return hashes;
}

std::uint64_t structural_hash(const CsgTree& tree) {
  return structural_hashes(tree).back();
}

}  // namespace cloud2csg
