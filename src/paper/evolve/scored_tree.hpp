#pragma once

#include <cstddef>

#include "cloud2csg/advanced/rank_classes.hpp"
#include "core/tree/local_search.hpp"

namespace cloud2csg {

/// Evaluates trees on a table and counts how many; one a thread.
class Evaluator {
 public:
  explicit Evaluator(const RankClasses& table) : table_(table) {}

  [[nodiscard]] double score(const CsgTree& tree) {
    ++evaluations_;
    work_ += static_cast<double>(table_.class_count()) * static_cast<double>(tree.size());
    return table_.score(tree, scratch_);
  }
  [[nodiscard]] double geometry(const CsgTree& tree) { return table_.geometry(tree, scratch_); }
  [[nodiscard]] std::size_t evaluations() const { return evaluations_; }
  /// Evaluations x classes x nodes.
  [[nodiscard]] double work() const { return work_; }
  [[nodiscard]] std::size_t primitives() const { return table_.primitive_count(); }

 private:
  const RankClasses& table_;
  RankScratch scratch_;
  std::size_t evaluations_ = 0;
  double work_ = 0;
};

}  // namespace cloud2csg
