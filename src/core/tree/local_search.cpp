#include "core/tree/local_search.hpp"

#include <array>
#include <utility>

namespace cloud2csg {
namespace {

constexpr std::array k_binary{Operation::union_of, Operation::intersection, Operation::difference};

/// Precondition: the operation is one of k_binary.
CsgTree joined(Operation operation, const CsgTree& a, const CsgTree& b) {
  if (operation == Operation::union_of) return unite(a, b);
  return operation == Operation::intersection ? intersect(a, b) : subtract(a, b);
}

bool is_spent(const TreeEvaluator& evaluator, const LocalSearchOptions& options) {
  return evaluator.evaluations() >= options.evaluation_limit || evaluator.work() >= options.work_limit;
}

class Neighbours {
 public:
  Neighbours(TreeEvaluator& evaluator, const ScoredTree& centre, const LocalSearchOptions& options,
             std::stop_token stop)
      : evaluator_(evaluator), centre_(centre), options_(options), stop_(std::move(stop)), best_(centre) {}

  ScoredTree best() {
    for (std::size_t node = 0; node < centre_.tree.size() && !is_at_end(); ++node) {
      shrink(node);
      if (options_.shrink_only) continue;
      change_operation(node);
      for (PrimitiveIndex p = 0; p < evaluator_.primitives() && !is_at_end(); ++p) {
        insert(node, CsgTree::leaf(p));
        if (!centre_.tree.nodes()[node].is_leaf() || centre_.tree.nodes()[node].primitive() != p) {
          consider(node, CsgTree::leaf(p));
        }
      }
    }
    return best_;
  }

 private:
  [[nodiscard]] bool is_at_end() const { return is_spent(evaluator_, options_) || stop_.stop_requested(); }

  void consider(std::size_t node, const CsgTree& replacement) {
    if (is_at_end()) return;
    ScoredTree neighbour{centre_.tree};
    neighbour.tree.replace(node, replacement.nodes());
    neighbour.score = evaluator_.score(neighbour.tree);
    if (neighbour.score > best_.score) best_ = std::move(neighbour);
  }

  [[nodiscard]] CsgTree child(std::size_t root) const { return CsgTree(centre_.tree.subtree(root)); }

  /// Replaces a node by one of its children, the second also complemented.
  void shrink(std::size_t node) {
    const CsgNode& here = centre_.tree.nodes()[node];
    if (here.is_leaf()) return;
    const CsgTree second = child(centre_.tree.second_child(node));
    consider(node, second);
    if (arity(here.operation()) < 2) return;
    consider(node, complement(second));
    consider(node, child(centre_.tree.first_child(node)));
  }

  void change_operation(std::size_t node) {
    const Operation now = centre_.tree.nodes()[node].operation();
    if (arity(now) < 2) return;
    const CsgTree first = child(centre_.tree.first_child(node));
    const CsgTree second = child(centre_.tree.second_child(node));
    for (const Operation operation : k_binary) {
      if (operation != now) consider(node, joined(operation, first, second));
    }
    consider(node, subtract(second, first));
  }

  void insert(std::size_t node, const CsgTree& leaf) {
    const Operation now = centre_.tree.nodes()[node].operation();
    // A constant has nothing to join, and tables evaluate it only as a whole tree.
    if (now == Operation::empty || now == Operation::full) return;
    const CsgTree here = child(node);
    for (const Operation operation : k_binary) consider(node, joined(operation, here, leaf));
    consider(node, subtract(leaf, here));
  }

  TreeEvaluator& evaluator_;
  const ScoredTree& centre_;
  const LocalSearchOptions& options_;
  std::stop_token stop_;
  ScoredTree best_;
};

}  // namespace

LocalOptimum local_search(const TreeObjective& objective, const CsgTree& start, const LocalSearchOptions& options,
                          const RunContext& run) {
  TreeEvaluator evaluator(objective);
  ScoredTree current{start, evaluator.score(start)};
  bool complete = true;
  while (!is_spent(evaluator, options)) {
    if (run.stop.stop_requested()) {
      complete = false;
      break;
    }
    ScoredTree better = Neighbours(evaluator, current, options, run.stop).best();
    if (better.score <= current.score) {
      complete = !run.stop.stop_requested();
      break;
    }
    current = std::move(better);
  }
  return {std::move(current), evaluator.evaluations(), complete};
}

}  // namespace cloud2csg
