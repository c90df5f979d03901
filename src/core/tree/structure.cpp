#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "core/tree/interner.hpp"

/// Equality up to commutation and association. A **chain** is a maximal run of nodes of one operation: for unions and
/// intersections through both children, for differences through the first child, ((a - b) - c) - d. Its **operands**
/// are what hangs off it; their order does not count, but for the first of a difference.
namespace cloud2csg {
namespace {

/// Whether a child belongs to the same chain as its parent.
bool continues_chain(Operation parent, Operation child, bool is_first) {
  return parent == child && arity(parent) == 2 && (parent != Operation::difference || is_first);
}

std::uint64_t salted(std::uint64_t value, Operation operation) {
  return mix(value ^ (static_cast<std::uint64_t>(operation) << 56U));
}

/// Per node: its hash and, for binary nodes, what a chain hands on to the node above. Sums do not depend on the order.
struct ChainHash {
  std::uint64_t hash = 0;
  std::uint64_t operands = 0;  ///< sum over the operands; of a difference, over the subtracted ones
  std::uint64_t base = 0;      ///< of a difference: hash of its first operand
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

/// Numbers the classes of equal subtrees, exactly; several trees may share the numbers.
class EqualityClasses {
 public:
  std::uint32_t class_of(const CsgTree& tree) {
    operands_.clear();
    counts_.clear();
    const std::vector<bool> inside_chain = inside_chains(tree);
    for (std::size_t i = 0; i < tree.size(); ++i) {
      const CsgNode node = tree.nodes()[i];
      const auto operation = static_cast<std::uint32_t>(node.operation());
      if (node.is_leaf()) {
        const bool is_primitive = node.operation() == Operation::primitive;
        key_ = {operation, is_primitive ? node.primitive() : 0};
        operands_.push_back(interner_.intern(key_));
        counts_.push_back(1);
        continue;
      }
      std::size_t count = 0;
      for (int child = arity(node.operation()); child > 0; --child) {
        count += counts_.back();
        counts_.pop_back();
      }
      if (!inside_chain[i]) {
        intern_chain(node.operation(), count);
        count = 1;
      }
      counts_.push_back(count);
    }
    return operands_.back();
  }

 private:
  static std::vector<bool> inside_chains(const CsgTree& tree) {
    std::vector<bool> inside(tree.size());
    for (std::size_t i = 0; i < tree.size(); ++i) {
      const Operation operation = tree.nodes()[i].operation();
      if (arity(operation) != 2) continue;
      const std::size_t first = tree.first_child(i);
      const std::size_t second = tree.second_child(i);
      inside[first] = continues_chain(operation, tree.nodes()[first].operation(), true);
      inside[second] = continues_chain(operation, tree.nodes()[second].operation(), false);
    }
    return inside;
  }

  /// Replaces the last `count` operands, a whole chain's, by the chain's class.
  void intern_chain(Operation operation, std::size_t count) {
    const auto operands = std::span(operands_).last(count);
    std::ranges::sort(operation == Operation::difference ? operands.subspan(1) : operands);
    key_.assign(1, static_cast<std::uint32_t>(operation));
    key_.insert(key_.end(), operands.begin(), operands.end());
    operands_.resize(operands_.size() - count);
    operands_.push_back(interner_.intern(key_));
  }

  Interner interner_;
  std::vector<std::uint32_t> operands_;  ///< classes of the operands of all chains that are still open
  std::vector<std::size_t> counts_;      ///< by subtree on the stack: how many operands it stands for
  std::vector<std::uint32_t> key_;
};

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

bool structurally_equal(const CsgTree& a, const CsgTree& b) {
  if (a.size() != b.size() || structural_hash(a) != structural_hash(b)) return false;
  EqualityClasses classes;
  return classes.class_of(a) == classes.class_of(b);
}

}  // namespace cloud2csg
