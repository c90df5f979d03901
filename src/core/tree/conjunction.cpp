#include "core/tree/conjunction.hpp"

#include <algorithm>
#include <cstddef>

namespace cloud2csg {
namespace {

/// Work left while a tree is taken apart: a node, plain or complemented, or a closing token.
struct Pending {
  std::size_t node;
  bool is_complemented;
  bool closes;
};

class FormulaWriter {
 public:
  explicit FormulaWriter(const CsgTree& tree) : tree_(tree) {
    formula_.primitives = primitives_of(tree);
    formula_.tokens.reserve(2 * tree.size() + 2);
  }

  Formula write() {
    formula_.tokens.push_back(k_open);
    pending_ = {{0, false, true}, {tree_.root(), false, false}};
    while (!pending_.empty()) {
      const Pending next = pending_.back();
      pending_.pop_back();
      if (next.closes) {
        formula_.tokens.push_back(k_close);
      } else {
        write_into_conjunction(next.node, next.is_complemented);
      }
    }
    return std::move(formula_);
  }

 private:
  void write_into_conjunction(std::size_t index, bool is_complemented) {
    const CsgNode node = tree_.nodes()[index];
    const Operation operation = node.operation();
    if (operation == Operation::primitive) {
      const auto place = std::ranges::lower_bound(formula_.primitives, node.primitive());
      const auto number = narrow(static_cast<std::size_t>(place - formula_.primitives.begin()));
      formula_.tokens.push_back(2 * number + (is_complemented ? 1 : 0));
    } else if (node.is_leaf()) {
      const bool is_empty = (operation == Operation::empty) != is_complemented;
      if (is_empty) formula_.tokens.insert(formula_.tokens.end(), {k_open, k_close});
    } else if (operation == Operation::complement) {
      pending_.push_back({tree_.second_child(index), !is_complemented, false});
    } else {
      write_binary(index, operation, is_complemented);
    }
  }

  void write_binary(std::size_t index, Operation operation, bool is_complemented) {
    // ~(x | y) = ~x & ~y, x & y and x - y = x & ~y join the open conjunction. Their complements open their own.
    const bool joins = (operation == Operation::union_of) == is_complemented;
    if (!joins) {
      formula_.tokens.push_back(k_open);
      pending_.push_back({0, false, true});
    }
    const bool complements_first = operation == Operation::union_of;
    const bool complements_second = operation != Operation::intersection;
    pending_.push_back({tree_.second_child(index), complements_second, false});
    pending_.push_back({tree_.first_child(index), complements_first, false});
  }

  const CsgTree& tree_;
  Formula formula_;
  std::vector<Pending> pending_;
};

/// Writes every conjunction, or its complement, as a bounded solid, which leaves out the points outside of all
/// primitives. Intersects the bounded members and subtracts the union of the unbounded members' complements. Where all
/// members are unbounded, so is the conjunction, and its complement is that union. So only the root needs a complement.
class TreeWriter {
 public:
  explicit TreeWriter(const Formula& formula) : formula_(formula), tokens_(formula.tokens) {}

  CsgTree write() {
    if (tokens_.size() == 2) return CsgTree::full();
    if (tokens_[1] == k_open && tokens_[2] == k_close) return CsgTree::empty();
    measure();
    frames_.push_back({0, 1, Phase::intersect, 0, 0});
    while (!frames_.empty()) step();
    if (is_unbounded_[0]) nodes_.push_back(CsgNode::inner(Operation::complement, narrow(nodes_.size() + 1)));
    return CsgTree(std::move(nodes_));
  }

 private:
  enum class Phase { intersect, unite };
  struct Frame {
    std::uint32_t open;
    std::uint32_t at;         ///< next member to look at
    Phase phase;              ///< bounded members come first, then the others
    std::size_t begin;        ///< where this conjunction's nodes begin
    std::size_t chain_begin;  ///< where the nodes of the current chain begin
  };

  void measure() {
    end_.resize(tokens_.size());
    is_unbounded_.resize(tokens_.size());
    std::vector<std::uint32_t> open;
    for (std::uint32_t i = 0; i < tokens_.size(); ++i) {
      bool member_is_unbounded = true;
      if (tokens_[i] == k_open) {
        open.push_back(i);
        is_unbounded_[i] = true;
        continue;
      }
      if (tokens_[i] == k_close) {
        const std::uint32_t closed = open.back();
        open.pop_back();
        end_[closed] = i + 1;
        member_is_unbounded = !is_unbounded_[closed];
      } else {
        member_is_unbounded = is_negative(tokens_[i]);
      }
      if (!open.empty() && !member_is_unbounded) is_unbounded_[open.back()] = false;
    }
  }

  [[nodiscard]] bool is_bounded_member(std::uint32_t member) const {
    return tokens_[member] == k_open ? is_unbounded_[member] : !is_negative(tokens_[member]);
  }

  void step() {
    Frame& frame = frames_.back();
    const bool intersects = frame.phase == Phase::intersect;
    const Operation chain = intersects ? Operation::intersection : Operation::union_of;
    if (frame.at > frame.open + 1) join_chain(frame, chain);
    while (tokens_[frame.at] != k_close && is_bounded_member(frame.at) != intersects) frame.at = next(frame.at);
    const std::uint32_t member = frame.at;
    if (tokens_[member] == k_close) {
      end_phase(frame);
      return;
    }
    frame.at = next(member);
    if (tokens_[member] == k_open) {
      const std::size_t begin = nodes_.size();
      frames_.push_back({member, member + 1, Phase::intersect, begin, begin});
    } else {
      nodes_.push_back(CsgNode::leaf(formula_.primitives[variable(tokens_[member])]));
    }
  }

  /// Joins the last member to the chain before it, if there are both.
  void join_chain(const Frame& frame, Operation chain) {
    const std::size_t length = nodes_.size() - frame.chain_begin;
    if (length < 2 || nodes_.back().length() == length) return;
    nodes_.push_back(CsgNode::inner(chain, narrow(length + 1)));
  }

  void end_phase(Frame& frame) {
    if (frame.phase == Phase::intersect) {
      frame.phase = Phase::unite;
      frame.at = frame.open + 1;
      frame.chain_begin = nodes_.size();
      return;
    }
    const bool has_both = frame.chain_begin > frame.begin && nodes_.size() > frame.chain_begin;
    if (has_both) nodes_.push_back(CsgNode::inner(Operation::difference, narrow(nodes_.size() - frame.begin + 1)));
    frames_.pop_back();
  }

  [[nodiscard]] std::uint32_t next(std::uint32_t member) const {
    return tokens_[member] == k_open ? end_[member] : member + 1;
  }

  const Formula& formula_;
  const std::vector<Token>& tokens_;
  std::vector<std::uint32_t> end_;
  std::vector<bool> is_unbounded_;  ///< by opening token
  std::vector<Frame> frames_;
  std::vector<CsgNode> nodes_;
};

}  // namespace

Formula to_formula(const CsgTree& tree) {
  return FormulaWriter(tree).write();
}

CsgTree to_tree(const Formula& formula) {
  return TreeWriter(formula).write();
}

void FormulaIndex::build(const Formula& formula) {
  first_class_code_ = narrow(2 * formula.primitives.size());
  next_.resize(formula.tokens.size());
  code_.resize(formula.tokens.size());
  classes_.clear();
  literals_.clear();
  codes_.clear();
  for (std::uint32_t i = 0; i < formula.tokens.size(); ++i) {
    const Token token = formula.tokens[i];
    if (token == k_open) {
      open_.push_back({i, codes_.size()});
    } else if (token == k_close) {
      close(i);
    } else {
      next_[i] = i + 1;
      code_[i] = token;
      codes_.push_back(token);
    }
  }
}

void FormulaIndex::close(std::uint32_t at) {
  const Open open = open_.back();
  open_.pop_back();
  const auto members = std::span(codes_).subspan(open.first_code);
  std::ranges::sort(members);
  const auto distinct = static_cast<std::size_t>(std::unique(members.begin(), members.end()) - members.begin());
  const std::uint32_t id = classes_.intern(members.first(distinct));
  if (id == literals_.size()) {
    std::uint32_t count = 0;
    for (const std::uint32_t code : members.first(distinct)) count += literals(code);
    literals_.push_back(count);
  }
  next_[open.token] = at + 1;
  code_[open.token] = first_class_code_ + id;
  codes_.resize(open.first_code);
  codes_.push_back(code_[open.token]);
}

}  // namespace cloud2csg
