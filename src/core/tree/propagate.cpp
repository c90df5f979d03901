#include "core/tree/propagate.hpp"

#include <algorithm>
#include <utility>

#include "core/base/narrow.hpp"

namespace cloud2csg {
namespace {

constexpr std::uint32_t k_none = 0xffffffffU;

}  // namespace

bool Propagation::run(Formula& formula, const FormulaIndex& index) {
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

void Propagation::read_literal() {
  Frame& frame = frames_.back();
  // Taken for granted because of another literal, here or around; the opposite was found on entering.
  const bool is_redundant = known_by_[variable(in_[at_])] != at_;
  if (is_redundant) {
    frame.changed = true;
  } else {
    out_.push_back(in_[at_]);
    ++frame.members;
  }
  ++at_;
}

void Propagation::read_conjunction() {
  if (is_known_empty(at_)) {
    frames_.back().changed = true;
    invalidate(at_);
    at_ = index_->next(at_);
  } else if (!enter()) {
    drop_empty_conjunction();
  }
}

/// Opens the conjunction at at_. Returns false when it contradicts itself or what is known.
bool Propagation::enter() {
  frames_.push_back(
      {.open = at_, .out_begin = narrow(out_.size()), .first_literal = literals_.size(), .first_known = known_.size()});
  out_.push_back(k_open);
  if (!assume_members(at_)) return false;
  ++at_;
  return true;
}

bool Propagation::assume_members(std::uint32_t open) {
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

void Propagation::forget(const Frame& frame) {
  for (; literals_.size() > frame.first_literal; literals_.pop_back()) known_by_[literals_.back()] = k_none;
  for (; known_.size() > frame.first_known; known_.pop_back()) {
    list_head_[known_.back().listed_under] = known_.back().next;
    known_at_[known_.back().open] = k_none;
  }
}

/// A conjunction that was changed or dropped on the strength of the others must not be used against them in turn.
void Propagation::invalidate(std::uint32_t open) {
  if (known_at_[open] != k_none) known_[known_at_[open]].is_valid = false;
}

bool Propagation::is_known_empty(std::uint32_t open) const {
  const std::uint32_t own_class = index_->class_of(open);
  const auto own_members = index_->members(own_class);
  for (const std::uint32_t member : own_members) {
    for (std::uint32_t k = list_head_[member]; k != k_none; k = known_[k].next) {
      const KnownEmpty& known = known_[k];
      if (!known.is_valid || known.open == open) continue;
      const std::uint32_t known_class = index_->class_of(known.open);
      // Of equal members of one conjunction the first stays.
      if (known_class == own_class && known.level == frames_.size() && known.open > open) continue;
      if (std::ranges::includes(own_members, index_->members(known_class))) return true;
    }
  }
  return false;
}

void Propagation::leave() {
  const Frame frame = frames_.back();
  frames_.pop_back();
  forget(frame);
  changed_ = changed_ || frame.changed;
  ++at_;
  if (frames_.empty()) {
    out_.push_back(k_close);
    return;
  }
  if (frame.members == 0) {  // all of space, so that the one around it is empty
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

/// The complement of a conjunction of one: of a literal, the opposite literal; of [...], what that holds.
void Propagation::dissolve(const Frame& frame) {
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
    outer.members += 2;  // or more: it was kept whole, so it holds two at least
  }
}

/// The innermost conjunction being read turned out empty: leaves it out, with what was written of it.
void Propagation::drop_empty_conjunction() {
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

}  // namespace cloud2csg
