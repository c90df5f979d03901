#include "merge/merge_check.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <set>
#include <utility>

#include "base/parallel.hpp"
#include "cloud2csg/restrict.hpp"

namespace cloud2csg {
namespace {

/// What a tree scores in a window, by nearest primitive (the window's local indices).
std::vector<double> scores_in(const MergeWindow& window, const CsgTree& tree) {
  RankScratch scratch;
  return window.table->sums_by_nearest(window.table->class_scores(localised(tree, window.primitives), scratch));
}

bool is_judged(const MergeWindow& window, PrimitiveIndex p) {
  return window.judged.value_or(p) == p;
}

}  // namespace

MergeCheck::MergeCheck(std::vector<MergeWindow> windows, std::size_t primitives, double alpha,
                       std::span<const Clique> cliques, std::span<const CsgTree> trees, RunContext run)
    : windows_(std::move(windows)), alpha_(alpha), run_(std::move(run)), promised_(primitives, 0.0) {
  assert(cliques.size() == trees.size());
  std::vector<std::vector<std::size_t>> cliques_with(primitives);
  for (std::size_t k = 0; k < cliques.size(); ++k) {
    for (const PrimitiveIndex p : cliques[k]) cliques_with[p].push_back(k);
  }
  // Each window promises for primitives of its own, so that windows may be looked at side by side.
  for_each_index_in_arena(windows_.size(), run_, [&](std::size_t w) {
    const MergeWindow& window = windows_[w];
    std::set<std::size_t> seen;
    for (const PrimitiveIndex p : window.primitives) {
      if (is_judged(window, p)) seen.insert(cliques_with[p].begin(), cliques_with[p].end());
    }
    for (const std::size_t k : seen) {
      const std::vector<double> scores = scores_in(window, trees[k]);
      for (std::size_t i = 0; i < scores.size(); ++i) {
        const PrimitiveIndex p = window.primitives[i];
        const bool is_of_clique = std::ranges::binary_search(cliques[k], p);
        if (is_of_clique && is_judged(window, p)) promised_[p] = std::max(promised_[p], scores[i]);
      }
    }
  });
}

MergeCheck::Verdict MergeCheck::judge(const CsgTree& merged) const {
  const TreeRestriction tree(merged);
  std::vector<std::vector<double>> scores(windows_.size());
  for_each_index_in_arena(windows_.size(), run_, [&](std::size_t w) {
    scores[w] = scores_in(windows_[w], tree.restrict_to(windows_[w].primitives));
  });
  std::vector<double> reached(promised_.size(), 0.0);
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    for (std::size_t i = 0; i < scores[w].size(); ++i) {
      const PrimitiveIndex p = windows_[w].primitives[i];
      if (is_judged(windows_[w], p)) reached[p] += scores[w][i];
    }
  }
  double worst = 0;
  for (std::size_t p = 0; p < promised_.size(); ++p) {
    const double missing = promised_[p] - reached[p];
    if (missing > alpha_) worst = std::max(worst, missing / promised_[p]);
  }
  const double geometry = std::accumulate(reached.begin(), reached.end(), 0.0);
  return {.score = geometry - alpha_ * static_cast<double>(merged.size()), .worst_shortfall = worst};
}

}  // namespace cloud2csg
