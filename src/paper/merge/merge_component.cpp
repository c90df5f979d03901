#include "paper/merge/merge_component.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "cloud2csg/advanced/merge.hpp"
#include "cloud2csg/advanced/restrict.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/base/parallel.hpp"

namespace cloud2csg {
namespace {

/// A tree's scores in a window, by nearest primitive (the window's local indices).
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

/// Trees of the cliques with a judged primitive that are whole in the window. If none is whole, trees of all cliques
/// with a judged primitive, restricted to the window, each distinct one once. These are few: most primitives are
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

/// The best score of partition trees with each of the window's primitives, on the points nearest to it.
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

/// A joint solution takes a pass over all points and a search: too long for more trees left over, or more primitives.
constexpr std::size_t k_joint_trees = 32;
constexpr std::size_t k_joint_primitives = 64;

Clique common(const Clique& a, const Clique& b) {
  Clique both;
  std::ranges::set_intersection(a, b, std::back_inserter(both));
  return both;
}

class ComponentMerger {
 public:
  ComponentMerger(const Component& component, const SolveJointly& solve_jointly, const ComponentOptions& options,
                  const RunContext& run)
      : component_(component),
        solve_jointly_(solve_jointly),
        options_(options),
        run_(run),
        check_(component.windows, component.primitives, component.alpha, component.cliques, component.trees, run) {}

  MergedComponent run() {
    const bool merged = component_.trees.size() == 1 ? consider(MergeWay::single, component_.trees.front(), true)
                                                     : merge_trees_of_partitions();
    if (!merged) search();
    if (options_.polish && has_whole_table()) polish();
    result_.tree = simplify(result_.tree);
    result_.statistics.worst_shortfall = check_.judge(result_.tree).worst_shortfall;
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool has_tree() const { return !result_.statistics.ways.empty(); }
  [[nodiscard]] bool has_whole_table() const { return component_.windows.size() == 1; }
  [[nodiscard]] const RankClasses& whole_table() const { return *component_.windows.front().table; }

  /// Keeps the best tree. Returns whether this one is whole, keeps the promises and is no worse than earlier ones.
  bool consider(MergeWay way, const CsgTree& found, bool whole) {
    const CsgTree tree = simplify(found);
    const auto [score, worst_shortfall] = check_.judge(tree);
    if (score > best_score_) {
      best_score_ = score;
      result_.tree = tree;
      result_.statistics.ways = {way};
    }
    if (!whole) return false;
    const bool holds = worst_shortfall <= k_tolerated_shortfall;
    if (!holds) ++result_.statistics.failed_checks;
    // A tree that holds but scores below an earlier one is not taken: go on looking.
    return holds && score >= best_score_;
  }

  bool merge_trees_of_partitions() {
    if (has_whole_table()) {
      return merge(MergeWay::paper) || merge(MergeWay::dominance) || merge(MergeWay::largest_common_subtree) ||
             merge_jointly();
    }
    // In a large component the paper's merge always gets something wrong.
    return merge(MergeWay::dominance) || merge(MergeWay::paper) || merge(MergeWay::largest_common_subtree) ||
           merge_jointly();
  }

  bool merge(MergeWay way) { return merge(way, component_.trees); }

  bool merge(MergeWay way, std::span<const CsgTree> trees) {
    const bool is_stopped = run_.stop.stop_requested();
    if (is_stopped) result_.complete = false;
    if (is_stopped && has_tree()) return false;
    const MergeResult merged = merge_result(way, trees);
    result_.statistics.merges += merged.merges;
    result_.statistics.blocked += merged.blocked;
    remaining_ = merged.trees;
    // Something is always blocked in a large component. The check tells whether it matters.
    const bool may_be_blocked = !has_whole_table();
    return consider(way, unite_all(merged.trees), merged.trees.size() == 1 && (merged.blocked == 0 || may_be_blocked));
  }

  /// Never stops the first way: it is short, and without it there is no tree.
  [[nodiscard]] MergeResult merge_result(MergeWay way, std::span<const CsgTree> trees) const {
    const bool is_first = way == (has_whole_table() ? MergeWay::paper : MergeWay::dominance);
    RunContext run = run_;
    if (is_first) run.stop = {};
    if (way == MergeWay::dominance) return merge_by_dominance(trees, component_.cliques, run);
    return merge_trees(trees, way == MergeWay::paper ? MergeOrder::paper : MergeOrder::largest_common_subtree, run);
  }

  /// Replaces two trees left over by one that is found from the points of both, again and again until all merge.
  bool merge_jointly() {
    std::vector<CsgTree> trees = remaining_;
    while (trees.size() > 1 && trees.size() <= k_joint_trees && !run_.stop.stop_requested()) {
      const auto [first, second] = most_entangled(trees);
      Clique both;
      std::ranges::set_union(primitives_of(trees[first]), primitives_of(trees[second]), std::back_inserter(both));
      if (both.empty()) return false;  // trees that contradict themselves, of which all of space is left
      if (both.size() > k_joint_primitives) return false;
      trees[first] = solve_jointly_(both);
      trees.erase(trees.begin() + static_cast<std::ptrdiff_t>(second));
      ++result_.statistics.joint_solutions;
      if (merge(MergeWay::joint, trees)) return true;
      trees = remaining_;
    }
    return false;
  }

  /// The cheapest pair to solve together: among those that share the most, the one with the fewest primitives in all.
  static std::pair<std::size_t, std::size_t> most_entangled(std::span<const CsgTree> trees) {
    std::pair<std::size_t, std::size_t> best{0, 1};
    std::pair<std::size_t, std::size_t> best_rank{0, std::numeric_limits<std::size_t>::max()};
    for (std::size_t a = 0; a < trees.size(); ++a) {
      for (std::size_t b = a + 1; b < trees.size(); ++b) {
        const Clique of_a = primitives_of(trees[a]);
        const Clique of_b = primitives_of(trees[b]);
        const std::size_t shared = common(of_a, of_b).size();
        const std::pair rank{shared, of_a.size() + of_b.size() - shared};
        if (rank.first > best_rank.first || (rank.first == best_rank.first && rank.second < best_rank.second)) {
          best = {a, b};
          best_rank = rank;
        }
      }
    }
    return best;
  }

  void search() {
    if (!has_whole_table()) {
      search_anew();
      return;
    }
    const Evolution found = evolve_tree_from(whole_table(), result_.tree, options_.search, options_.item, run_);
    count(found);
    consider(MergeWay::search, found.tree, true);
    result_.statistics.ways = {MergeWay::search};  // it began with the best tree so far, which may still be the best
  }

  /// For a component without a table over all of it.
  void search_anew() {
    if (component_.primitives > RankClasses::k_byte_limit || run_.stop.stop_requested()) return;
    Clique all(component_.primitives);
    std::iota(all.begin(), all.end(), PrimitiveIndex{0});
    consider(MergeWay::search, solve_jointly_(all), true);
  }

  /// Removes redundant nodes of the whole component as long as E grows.
  void polish() {
    const Evolution polished = local_search(whole_table(), result_.tree, {.shrink_only = true}, run_);
    count(polished);
    result_.tree = polished.tree;
  }

  void count(const Evolution& evolution) {
    result_.statistics.generations += evolution.generations;
    result_.statistics.evaluations += evolution.evaluations;
    result_.complete = result_.complete && evolution.complete;
  }

  const Component& component_;
  const SolveJointly& solve_jointly_;
  const ComponentOptions& options_;
  const RunContext& run_;
  MergeCheck check_;
  MergedComponent result_;
  std::vector<CsgTree> remaining_;
  double best_score_ = -std::numeric_limits<double>::infinity();
};

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

MergedComponent merge_component(const Component& component, const SolveJointly& solve_jointly,
                                const ComponentOptions& options, const RunContext& run) {
  return ComponentMerger(component, solve_jointly, options, run).run();
}

}  // namespace cloud2csg
