#pragma once

#include <cstdint>
#include <stop_token>
#include <utility>

namespace cloud2csg {

/// How much work may still be done: counted, so that a result does not depend on the machine, but for a stop.
class WorkBudget {
 public:
  WorkBudget(std::uint64_t limit, std::stop_token stop) : left_(limit), stop_(std::move(stop)) {}

  /// Takes some of the budget. False when there is not enough, and ever after.
  [[nodiscard]] bool spend(std::uint64_t work) {
    if (work > left_ || stop_.stop_requested()) is_exhausted_ = true;
    if (!is_exhausted_) left_ -= work;
    return !is_exhausted_;
  }
  [[nodiscard]] std::uint64_t left() const { return left_; }
  [[nodiscard]] bool is_exhausted() const { return is_exhausted_; }

 private:
  std::uint64_t left_;
  std::stop_token stop_;
  bool is_exhausted_ = false;
};

}  // namespace cloud2csg
