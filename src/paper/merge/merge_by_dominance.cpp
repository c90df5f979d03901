#include <algorithm>
#include <cassert>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/merge.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/tree/folding.hpp"

namespace cloud2csg {
namespace {

enum class Role { undecided, added, removed };

/// The tree with one primitive replaced by nothing or by all of space.
CsgTree substitute(const CsgTree& tree, PrimitiveIndex primitive, bool is_full) {
  return fold_primitives(tree,
                         [&](PrimitiveIndex p) { return p == primitive ? std::optional(is_full) : std::nullopt; });
}

/// Primitives of one role, which are taken out of all trees one after the other.
struct Layer {
  Role role;
  std::vector<PrimitiveIndex> primitives;
};

class DominanceMerge {
 public:
  DominanceMerge(std::span<const CsgTree> trees, std::span<const Clique> cliques, const RunContext& run) : run_(run) {
    assert(trees.size() == cliques.size());
    for (std::size_t k = 0; k < trees.size(); ++k) add(simplify(trees[k]), cliques[k]);
    decided_.assign(trees_with_.size(), 0);
    for (PrimitiveIndex p = 0; p < trees_with_.size(); ++p) mark_stale(p);
  }

  MergeResult merge() {
    while (!(stale_added_.empty() && stale_removed_.empty()) && !run_.stop.stop_requested()) {
      // Subtracted primitives go first, so that differences stand outermost where there is a choice.
      peel(Role::removed, stale_removed_);
      peel(Role::added, stale_added_);
    }
    MergeResult result = merge_trees(core(), MergeOrder::paper, run_);
    for (const Layer& layer : layers_) result.merges += layer.primitives.size();
    result.trees = {simplify(with_layers(unite_all(result.trees)))};
    return result;
  }

 private:
  void add(CsgTree tree, const Clique& clique) {
    if (tree == CsgTree::empty()) return;
    for (const PrimitiveIndex p : clique) {
      if (p >= trees_with_.size()) trees_with_.resize(p + std::size_t{1});
      trees_with_[p].push_back(trees_.size());
    }
    trees_.push_back(std::move(tree));
    cliques_.push_back(clique);
  }

  void mark_stale(PrimitiveIndex p) {
    stale_added_.insert(p);
    stale_removed_.insert(p);
  }

  /// The primitive's role in a partition. Absent when nothing is left of the tree.
  [[nodiscard]] std::optional<Role> claim_of(std::size_t tree, PrimitiveIndex p) const {
    if (is_constant(trees_[tree])) return std::nullopt;
    const CsgTree inside = substitute(trees_[tree], p, /*is_full=*/true);
    // Inside the primitive the tree still depends on others, which must go first.
    if (!is_constant(inside)) return Role::undecided;
    return inside == CsgTree::full() ? Role::added : Role::removed;
  }

  /// The primitive's role, if all partitions that have it agree.
  [[nodiscard]] Role role_of(PrimitiveIndex p) {
    const std::vector<std::size_t>& trees = trees_with_[p];
    // A decided tree stays so, whatever is taken out: ask the first that has not decided.
    for (std::size_t& k = decided_[p]; k < trees.size(); ++k) {
      if (claim_of(trees[k], p) == Role::undecided) return Role::undecided;
    }
    Role common = Role::undecided;
    for (const std::size_t k : trees) {
      const std::optional<Role> claim = claim_of(k, p);
      if (!claim) continue;
      const bool differs = common != Role::undecided && *claim != common;
      if (differs || *claim == Role::undecided) return Role::undecided;
      common = *claim;
    }
    return common;
  }

  /// Takes out all primitives of the role as a layer, also those that get the role on the way.
  void peel(Role role, std::set<PrimitiveIndex>& stale) {
    Layer layer{.role = role, .primitives = {}};
    while (!stale.empty() && !run_.stop.stop_requested()) {
      const PrimitiveIndex p = *stale.begin();
      stale.erase(stale.begin());
      if (role_of(p) != role) continue;
      layer.primitives.push_back(p);
      take_out(p);
    }
    if (!layer.primitives.empty()) layers_.push_back(std::move(layer));
  }

  /// Restricts all trees with the primitive to its outside.
  void take_out(PrimitiveIndex p) {
    for (const std::size_t k : std::exchange(trees_with_[p], {})) {
      trees_[k] = simplify(substitute(trees_[k], p, /*is_full=*/false));
      for (const PrimitiveIndex q : cliques_[k]) {
        if (!trees_with_[q].empty()) mark_stale(q);
      }
    }
  }

  /// The trees left over, of primitives neither wholly in the solid nor wholly out. All of space when every tree is.
  [[nodiscard]] std::vector<CsgTree> core() const {
    const auto is_full = [](const CsgTree& tree) { return tree == CsgTree::full(); };
    if (!trees_.empty() && std::ranges::all_of(trees_, is_full)) return {CsgTree::full()};
    std::vector<CsgTree> left;
    for (const CsgTree& tree : trees_) {
      if (!is_constant(tree)) left.push_back(tree);
    }
    return left;
  }

  [[nodiscard]] CsgTree with_layers(CsgTree tree) const {
    for (std::size_t k = layers_.size(); k-- > 0;) {
      std::vector<CsgTree> leaves;
      for (const PrimitiveIndex p : layers_[k].primitives) leaves.push_back(CsgTree::leaf(p));
      const CsgTree all = unite_all(leaves);
      tree = layers_[k].role == Role::removed ? subtract(tree, all) : unite(tree, all);
    }
    return tree;
  }

  const RunContext& run_;
  std::vector<CsgTree> trees_;
  std::vector<Clique> cliques_;
  std::vector<std::vector<std::size_t>> trees_with_;      ///< by primitive
  std::vector<std::size_t> decided_;                      ///< by primitive: how many of its first trees have decided
  std::set<PrimitiveIndex> stale_added_, stale_removed_;  ///< primitives whose role may have become this one
  std::vector<Layer> layers_;                             ///< outermost first
};

}  // namespace

MergeResult merge_by_dominance(std::span<const CsgTree> trees, std::span<const Clique> cliques, const RunContext& run) {
  return DominanceMerge(trees, cliques, run).merge();
}

}  // namespace cloud2csg
