#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "core/tree/conjunction.hpp"

namespace cloud2csg {
namespace {

constexpr std::uint32_t k_none = 0xffffffffU;

/// One pass of the rules that follow from known facts. A member of a conjunction may assume all other members and
/// everything that surrounds the conjunction. A literal known to hold is left out. One known not to hold makes its
/// conjunction empty. An inner conjunction with all members of a known empty one is empty itself. These rules cover
/// idempotence, absorption, complementary pairs, empty and full, and all nested differences. Conjunctions of one member
/// are dissolved (double complement).
class Propagation {
 public:
  /// Returns whether anything changed; then another pass may find more. `index` belongs to the incoming `formula`.
  /// O(size x members known to be empty that share a member); mostly O(size).
  bool run(Formula& formula, const FormulaIndex& index) {
    index_ = &index;
    in_.swap(formula.tokens);
    out_.clear();
    changed_ = false;
    known_by_.assign(formula.primitives.size(), k_none);
    known_at_.assign(in_.size(), k_none);
    list_head_.assign(index.code_count(), k_none);
    literals_.clear();
    known_.clear();
    at_ = 0;
    if (!enter()) drop_empty_conjunction();
    while (!frames_.empty()) {
      if (in_[at_] == k_close) {
        leave();
      } else if (in_[at_] == k_open) {
        read_conjunction();
      } else {
        read_literal();
      }
    }
    formula.tokens.swap(out_);
    return changed_;
  }

 private:
  /// A conjunction that is being read.
  struct Frame {
    std::uint32_t open;       ///< its opening token in the input...
    std::uint32_t out_begin;  ///< ...and in the output
    std::size_t first_literal;
    std::size_t first_known;
    std::uint32_t members = 0;  ///< members written so far
    bool changed = false;
  };
  /// An inner conjunction known to be empty, listed under its first member.
  struct KnownEmpty {
    std::uint32_t open;
    std::uint32_t next;  ///< next of the list: position in known_
    std::uint32_t listed_under;
    std::size_t level;  ///< frames around it
    bool is_valid;
  };

  void read_literal() {
    Frame& frame = frames_.back();
    // Another literal here or around implies it. Its opposite was found on entering.
    const bool is_redundant = known_by_[variable(in_[at_])] != at_;
    if (is_redundant) {
      frame.changed = true;
    } else {
      out_.push_back(in_[at_]);
      ++frame.members;
    }
    ++at_;
  }

  void read_conjunction() {
    if (is_known_empty(at_)) {
      frames_.back().changed = true;
      invalidate(at_);
      at_ = index_->next(at_);
    } else if (!enter()) {
      drop_empty_conjunction();
    }
  }

  /// Opens the conjunction at at_. Returns false when it contradicts itself or known facts.
  bool enter() {
    frames_.push_back({.open = at_,
                       .out_begin = narrow(out_.size()),
                       .first_literal = literals_.size(),
                       .first_known = known_.size()});
    out_.push_back(k_open);
    if (!assume_members(at_)) return false;
    ++at_;
    return true;
  }

  bool assume_members(std::uint32_t open) {
    for (std::uint32_t member = open + 1; in_[member] != k_close; member = index_->next(member)) {
      const Token token = in_[member];
      if (token == k_open) {
        const auto members = index_->members(index_->class_of(member));
        if (members.empty()) return false;
        known_at_[member] = narrow(known_.size());
        known_.push_back({.open = member,
                          .next = list_head_[members.front()],
                          .listed_under = members.front(),
                          .level = frames_.size(),
                          .is_valid = true});
        list_head_[members.front()] = known_at_[member];
      } else if (known_by_[variable(token)] == k_none) {
        known_by_[variable(token)] = member;
        literals_.push_back(variable(token));
      } else if (in_[known_by_[variable(token)]] != token) {
        return false;
      }
    }
    return true;
  }

  void forget(const Frame& frame) {
    for (; literals_.size() > frame.first_literal; literals_.pop_back()) known_by_[literals_.back()] = k_none;
    for (; known_.size() > frame.first_known; known_.pop_back()) {
      list_head_[known_.back().listed_under] = known_.back().next;
      known_at_[known_.back().open] = k_none;
    }
  }

  /// A conjunction that was changed or dropped because of others must not be used against them in turn.
  void invalidate(std::uint32_t open) {
    if (known_at_[open] != k_none) known_[known_at_[open]].is_valid = false;
  }

  [[nodiscard]] bool is_known_empty(std::uint32_t open) const {
    const std::uint32_t own_class = index_->class_of(open);
    const auto own_members = index_->members(own_class);
    for (const std::uint32_t member : own_members) {
      for (std::uint32_t k = list_head_[member]; k != k_none; k = known_[k].next) {
        const KnownEmpty& known = known_[k];
        if (!known.is_valid || known.open == open) continue;
        const std::uint32_t known_class = index_->class_of(known.open);
        // Among equal members of a conjunction the first stays.
        if (known_class == own_class && known.level == frames_.size() && known.open > open) continue;
        if (std::ranges::includes(own_members, index_->members(known_class))) return true;
      }
    }
    return false;
  }

  void leave() {
    const Frame frame = frames_.back();
    frames_.pop_back();
    forget(frame);
    changed_ = changed_ || frame.changed;
    ++at_;
    if (frames_.empty()) {
      out_.push_back(k_close);
      return;
    }
    if (frame.members == 0) {  // all of space, so the surrounding conjunction is empty
      drop_empty_conjunction();
      return;
    }
    Frame& outer = frames_.back();
    if (frame.members == 1) {
      dissolve(frame);
    } else {
      out_.push_back(k_close);
      ++outer.members;
    }
    if (frame.changed || frame.members == 1) {
      outer.changed = true;
      invalidate(frame.open);
    }
  }

  /// Writes the complement of a conjunction of one member: of a literal the opposite, of [...] its members.
  void dissolve(const Frame& frame) {
    Frame& outer = frames_.back();
    Token& only = out_[frame.out_begin + 1];
    if (only != k_open) {
      out_[frame.out_begin] = negated(only);
      out_.pop_back();
      outer.members += 1;
    } else {
      const auto begin = out_.begin() + frame.out_begin;
      out_.erase(begin, begin + 2);
      out_.pop_back();
      outer.members += 2;  // or more: it was kept whole, so it holds at least two
    }
  }

  /// Drops the innermost conjunction being read, which is empty, with all that was written of it.
  void drop_empty_conjunction() {
    const Frame frame = frames_.back();
    frames_.pop_back();
    forget(frame);
    out_.resize(frame.out_begin);
    changed_ = true;
    if (frames_.empty()) {
      out_ = {k_open, k_open, k_close, k_close};
      changed_ = out_ != in_;
      return;
    }
    frames_.back().changed = true;
    invalidate(frame.open);
    at_ = index_->next(frame.open);
  }

  const FormulaIndex* index_ = nullptr;
  std::vector<Token> in_;
  std::vector<Token> out_;
  std::uint32_t at_ = 0;
  bool changed_ = false;
  std::vector<Frame> frames_;
  std::vector<std::uint32_t> known_by_;  ///< by variable: token of the assumed literal, or k_none
  std::vector<std::uint32_t> literals_;  ///< variables in known_by_, latest last
  std::vector<KnownEmpty> known_;
  std::vector<std::uint32_t> list_head_;  ///< by member code: latest of known_ listed under it, or k_none
  std::vector<std::uint32_t> known_at_;   ///< by opening token: position in known_, or k_none
};

/// Factors out common members of inner conjunctions: [~[f x] ~[f y]] = [~[f ~[~[x] ~[y]]]], that is (f & x) | (f & y) =
/// f & (x | y) and its dual. Takes the factor that saves most literals first.
class Factoring {
 public:
  /// Returns whether anything changed: the formula is then shorter, but may hold conjunctions of one member. O(size).
  bool run(Formula& formula, const FormulaIndex& index) {
    index_ = &index;
    in_.swap(formula.tokens);
    out_.clear();
    count_.assign(index.code_count(), 0);
    bool changed = false;
    for (std::uint32_t at = 0; at < in_.size();) {
      if (in_[at] != k_open || !find_group(at)) {
        out_.push_back(in_[at++]);
        continue;
      }
      changed = true;
      out_.push_back(k_open);
      for (std::uint32_t member = at + 1; in_[member] != k_close; member = index.next(member)) {
        if (member == group_.front()) {
          write_group();
        } else if (in_[member] != k_open || !std::ranges::binary_search(group_, member)) {
          out_.insert(out_.end(), in_.begin() + member, in_.begin() + index.next(member));
        }
      }
      out_.push_back(k_close);
      at = index.next(at);
    }
    formula.tokens.swap(out_);
    return changed;
  }

 private:
  /// Fills group_ and factor_ for the conjunction that opens at `open`. False when no two members share anything.
  bool find_group(std::uint32_t open) {
    inner_.clear();
    for (std::uint32_t member = open + 1; in_[member] != k_close; member = index_->next(member)) {
      if (in_[member] == k_open) inner_.push_back(member);
    }
    if (inner_.size() < 2) return false;
    for (const std::uint32_t member : inner_) {
      for (const std::uint32_t code : index_->members(index_->class_of(member))) {
        if (count_[code]++ == 0) touched_.push_back(code);
      }
    }
    const std::uint32_t best = best_code();
    const bool is_shared = count_[best] > 1;
    for (const std::uint32_t code : touched_) count_[code] = 0;
    touched_.clear();
    if (!is_shared) return false;

    group_.clear();
    factor_.clear();
    std::vector<std::uint32_t> common;
    for (const std::uint32_t member : inner_) {
      const auto codes = index_->members(index_->class_of(member));
      if (!std::ranges::binary_search(codes, best)) continue;
      common.clear();
      if (group_.empty()) {
        common.assign(codes.begin(), codes.end());
      } else {
        std::ranges::set_intersection(factor_, codes, std::back_inserter(common));
      }
      factor_.swap(common);
      group_.push_back(member);
    }
    return true;
  }

  /// The touched code that saves most literals when written once instead of each time; the first on ties.
  [[nodiscard]] std::uint32_t best_code() const {
    const auto saved = [this](std::uint32_t code) { return std::uint64_t{count_[code] - 1} * index_->literals(code); };
    return *std::ranges::max_element(touched_, {}, saved);
  }

  void write_group() {
    out_.push_back(k_open);
    write_members(group_.front(), true);
    out_.push_back(k_open);
    for (const std::uint32_t member : group_) {
      out_.push_back(k_open);
      write_members(member, false);
      out_.push_back(k_close);
    }
    out_.push_back(k_close);
    out_.push_back(k_close);
  }

  /// Writes the members of a conjunction that are part of the factor, or those that are not.
  void write_members(std::uint32_t open, bool in_factor) {
    for (std::uint32_t member = open + 1; in_[member] != k_close; member = index_->next(member)) {
      if (std::ranges::binary_search(factor_, index_->code(member)) != in_factor) continue;
      out_.insert(out_.end(), in_.begin() + member, in_.begin() + index_->next(member));
    }
  }

  const FormulaIndex* index_ = nullptr;
  std::vector<Token> in_;
  std::vector<Token> out_;
  std::vector<std::uint32_t> inner_;    ///< opening tokens of the current inner conjunctions
  std::vector<std::uint32_t> group_;    ///< those of inner_ that share the factor
  std::vector<std::uint32_t> factor_;   ///< codes that all of group_ hold, ascending
  std::vector<std::uint32_t> count_;    ///< by code: how many of inner_ hold it
  std::vector<std::uint32_t> touched_;  ///< codes whose count is not 0
};

}  // namespace

CsgTree simplify(const CsgTree& tree) {
  Formula formula = to_formula(tree);
  FormulaIndex index;
  Propagation propagation;
  Factoring factoring;
  do {
    do index.build(formula);
    while (propagation.run(formula, index));
  } while (factoring.run(formula, index));
  return to_tree(formula);
}

}  // namespace cloud2csg
