#include "core/tree/factor.hpp"

#include <algorithm>
#include <iterator>

namespace cloud2csg {

bool Factoring::run(Formula& formula, const FormulaIndex& index) {
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

/// Fills group_ and factor_ for the conjunction that opens here; false when no two members share anything.
bool Factoring::find_group(std::uint32_t open) {
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

/// The touched code that saves most literals when it is written once instead of every time; of equal ones the first.
std::uint32_t Factoring::best_code() const {
  const auto saved = [this](std::uint32_t code) { return std::uint64_t{count_[code] - 1} * index_->literals(code); };
  return *std::ranges::max_element(touched_, {}, saved);
}

void Factoring::write_group() {
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
void Factoring::write_members(std::uint32_t open, bool in_factor) {
  for (std::uint32_t member = open + 1; in_[member] != k_close; member = index_->next(member)) {
    if (std::ranges::binary_search(factor_, index_->code(member)) != in_factor) continue;
    out_.insert(out_.end(), in_.begin() + member, in_.begin() + index_->next(member));
  }
}

}  // namespace cloud2csg
