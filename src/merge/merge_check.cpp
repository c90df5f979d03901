#include "merge/merge_check.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "cloud2csg/restrict.hpp"

namespace cloud2csg {
namespace {

/// Evaluates trees of the component in its windows.
class WindowScores {
 public:
  explicit WindowScores(std::size_t primitives) : sums_(primitives, 0.0), local_(primitives, 0) {}

  /// Adds what a tree scores in a window, by nearest primitive.
  void add(const MergeWindow& window, const TreeRestriction& tree) {
    for (std::size_t i = 0; i < window.primitives.size(); ++i) {
      local_[window.primitives[i]] = static_cast<PrimitiveIndex>(i);
    }
    const CsgTree here = renumber(tree.restrict_to(window.primitives), local_);
    const std::vector<double> sums = window.table->sums_by_nearest(window.table->class_scores(here, scratch_));
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const PrimitiveIndex p = window.primitives[i];
      if (window.judged.value_or(p) == p) sums_[p] += sums[i];
    }
  }

  [[nodiscard]] std::vector<double>& sums() { return sums_; }

 private:
  std::vector<double> sums_;
  std::vector<PrimitiveIndex> local_;
  RankScratch scratch_;
};

/// By primitive: the window where points nearest to it are judged.
std::vector<std::size_t> windows_by_primitive(std::span<const MergeWindow> windows, std::size_t primitives) {
  std::vector<std::size_t> window_of(primitives, 0);
  for (std::size_t w = 0; w < windows.size(); ++w) {
    if (windows[w].judged) window_of[*windows[w].judged] = w;
  }
  return window_of;
}

}  // namespace

MergeCheck::MergeCheck(std::vector<MergeWindow> windows, std::size_t primitives, double alpha,
                       std::span<const Clique> cliques, std::span<const CsgTree> trees)
    : windows_(std::move(windows)), alpha_(alpha), promised_(primitives, 0.0) {
  assert(cliques.size() == trees.size());
  const std::vector<std::size_t> window_of = windows_by_primitive(windows_, primitives);
  WindowScores scores(primitives);
  for (std::size_t k = 0; k < trees.size(); ++k) {
    const TreeRestriction tree(trees[k]);
    std::vector<std::size_t> seen_in;
    for (const PrimitiveIndex p : cliques[k]) seen_in.push_back(window_of[p]);
    std::ranges::sort(seen_in);
    seen_in.erase(std::unique(seen_in.begin(), seen_in.end()), seen_in.end());
    for (const std::size_t w : seen_in) scores.add(windows_[w], tree);
    for (const PrimitiveIndex p : cliques[k]) promised_[p] = std::max(promised_[p], scores.sums()[p]);
    std::ranges::fill(scores.sums(), 0.0);
  }
}

MergeCheck::Verdict MergeCheck::judge(const CsgTree& merged) const {
  WindowScores scores(promised_.size());
  const TreeRestriction tree(merged);
  for (const MergeWindow& window : windows_) scores.add(window, tree);
  const std::vector<double>& reached = scores.sums();
  double worst = 0;
  for (std::size_t p = 0; p < promised_.size(); ++p) {
    const double missing = promised_[p] - reached[p];
    if (missing > alpha_) worst = std::max(worst, missing / promised_[p]);
  }
  const double geometry = std::accumulate(reached.begin(), reached.end(), 0.0);
  return {.score = geometry - alpha_ * static_cast<double>(merged.size()), .worst_shortfall = worst};
}

}  // namespace cloud2csg
