#include "paper/merge/merge_check.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <set>
#include <utility>

#include "cloud2csg/advanced/restrict.hpp"
#include "core/base/parallel.hpp"

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

/// A partition's tree in a window, and the partition's primitives.
struct Witness {
  CsgTree tree;
  const Clique* clique;
};

/// The trees of the cliques with primitives that are judged in the window, where the window has all of their
/// primitives. Without any such: of all, each different one once, which are few, as most of their primitives are
/// elsewhere.
std::vector<Witness> witnesses_in(const MergeWindow& window, std::span<const Clique> cliques,
                                  std::span<const CsgTree> trees,
                                  std::span<const std::vector<std::size_t>> cliques_with) {
  std::set<std::size_t> whole, cut;
  for (const PrimitiveIndex p : window.primitives) {
    if (!is_judged(window, p)) continue;
    for (const std::size_t k : cliques_with[p]) {
      (std::ranges::includes(window.primitives, cliques[k]) ? whole : cut).insert(k);
    }
  }
  std::vector<Witness> witnesses;
  witnesses.reserve(whole.size());
  for (const std::size_t k : whole) witnesses.push_back({.tree = trees[k], .clique = &cliques[k]});
  if (!whole.empty()) return witnesses;
  for (const std::size_t k : cut) {
    CsgTree tree = restrict_to(trees[k], window.primitives);
    const auto is_known = [&tree](const Witness& witness) { return witness.tree == tree; };
    if (std::ranges::none_of(witnesses, is_known)) witnesses.push_back({std::move(tree), &cliques[k]});
  }
  return witnesses;
}

/// The best that trees of partitions with each of the window's primitives score on the points nearest to it.
std::vector<double> promises_in(const MergeWindow& window, std::span<const Clique> cliques,
                                std::span<const CsgTree> trees,
                                std::span<const std::vector<std::size_t>> cliques_with) {
  std::vector<double> promises(window.primitives.size(), 0.0);
  for (const Witness& witness : witnesses_in(window, cliques, trees, cliques_with)) {
    const std::vector<double> scores = scores_in(window, witness.tree);
    for (std::size_t i = 0; i < scores.size(); ++i) {
      const PrimitiveIndex p = window.primitives[i];
      if (is_judged(window, p) && std::ranges::binary_search(*witness.clique, p)) {
        promises[i] = std::max(promises[i], scores[i]);
      }
    }
  }
  return promises;
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
  std::vector<std::vector<double>> promises(windows_.size());
  for_each_index_in_arena(windows_.size(), run_,
                          [&](std::size_t w) { promises[w] = promises_in(windows_[w], cliques, trees, cliques_with); });
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    for (std::size_t i = 0; i < promises[w].size(); ++i) promised_[windows_[w].primitives[i]] += promises[w][i];
  }
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
