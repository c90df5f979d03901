#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/advanced/rank_classes.hpp"
#include "cloud2csg/extract.hpp"

namespace cloud2csg {

/// Points of a component with the primitives that tell what any tree is at them: the whole component, or, where that is
/// too large for a table, the points of one primitive, or some of them, with it and all that overlap it near them.
struct MergeWindow {
  const RankClasses* table;
  std::vector<PrimitiveIndex> primitives;     ///< by local index of the table: index in the component; ascending
  std::optional<PrimitiveIndex> judged = {};  ///< only points nearest to this one count; absent: all
};

/// What partition trees promise on the points of a whole component, and how far a merged tree falls short of it.
///
/// For each primitive, the promise is the best that a partition tree with that primitive reaches on the points nearest
/// to it. It is kept by primitive, so that a small feature that was lost is seen although it weighs little in the
/// whole.
class MergeCheck {
 public:
  /// `cliques` and `trees` belong together; they index the component's `primitives`. What less than `alpha`, the cost
  /// of a node, tells is taken for noise. A primitive may be judged in several windows, which must share no points:
  /// promises and scores are summed over them. Works on the threads of the task arena that the caller is in, unless
  /// run.threads == 1. The windows' tables must outlive this. O(sum over the cliques of their windows' classes).
  MergeCheck(std::vector<MergeWindow> windows, std::size_t primitives, double alpha, std::span<const Clique> cliques,
             std::span<const CsgTree> trees, RunContext run = {.threads = 1});

  struct Verdict {
    double score;            ///< E(t) over all windows
    double worst_shortfall;  ///< the largest share of a primitive's promise that the tree does not reach; 0: none
  };
  /// O(classes x size of the tree within their window).
  [[nodiscard]] Verdict judge(const CsgTree& merged) const;

 private:
  std::vector<MergeWindow> windows_;
  double alpha_;
  RunContext run_;
  std::vector<double> promised_;  // by primitive
};

/// A connected component of the overlap graph with the trees of its partitions; all indices are the component's.
struct Component {
  std::size_t primitives = 0;             ///< how many
  std::vector<MergeWindow> windows = {};  ///< one over all primitives, or some for each
  double alpha = 0;                       ///< cost of a node
  std::vector<Clique> cliques = {};
  std::vector<CsgTree> trees = {};  ///< one a clique
};

/// Finds the tree of a set of primitives from the points that belong to them; component's indices in and out.
using SolveJointly = std::function<CsgTree(const Clique&)>;

/// A merged tree passes when no primitive's surface loses more than this share of what its partitions reached. Trees
/// that agree differ by a few per mille, near edges where one partition does not see the other's primitives.
inline constexpr double k_tolerated_shortfall = 0.05;

struct ComponentOptions {
  const GaOptions& search;
  bool polish;
  std::uint64_t item;  ///< tells the component's random streams apart from the partitions'
};

/// One tree for the component: the paper's merge, held against what the partitions promised; where it does not go
/// through or does not hold, by dominance, by largest common subtrees, by solving partitions that block each other
/// together, by a search over the whole component if it is not too large. The best tree that was met, so an answer
/// always comes. Fills in `statistics`' way.
struct MergedComponent {
  CsgTree tree;
  MergeStatistics statistics;  ///< with one entry in ways
  bool complete = true;
};
[[nodiscard]] MergedComponent merge_component(const Component& component, const SolveJointly& solve_jointly,
                                              const ComponentOptions& options, const RunContext& run);

}  // namespace cloud2csg
