#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/advanced/rank_classes.hpp"
#include "cloud2csg/extract.hpp"

namespace cloud2csg {

/// Points with the primitives that decide any tree there: the whole component or, where that is too large for a table,
/// the points of one primitive, or some of them, with it and all that overlaps it near them.
struct MergeWindow {
  const RankClasses* table;
  std::vector<PrimitiveIndex> primitives;     ///< component's index by local index of the table, ascending
  std::optional<PrimitiveIndex> judged = {};  ///< only points nearest to this one count; absent: all
};

/// The partition trees' promises on the points of a component, and how far a merged tree falls short. A primitive's
/// promise is the best that a partition tree with it reaches on the points nearest to it. Promises are by primitive, so
/// that the loss of a small feature shows although it weighs little in the whole.
class MergeCheck {
 public:
  /// `cliques` and `trees` correspond, in indices of the component's `primitives`. Shortfalls below `alpha`, a node's
  /// cost, are noise. A primitive may be judged in several windows, which must share no points: promises and scores are
  /// summed. Works on the threads of the caller's task arena, unless run.threads == 1. The windows' tables must outlive
  /// this. O(sum over the cliques of their windows' classes).
  MergeCheck(std::vector<MergeWindow> windows, std::size_t primitives, double alpha, std::span<const Clique> cliques,
             std::span<const CsgTree> trees, RunContext run = {.threads = 1});

  struct Verdict {
    double score;            ///< E(t) over all windows
    double worst_shortfall;  ///< the largest share of a primitive's promise that the tree misses; 0: none
  };
  /// O(classes x size of the tree within their window).
  [[nodiscard]] Verdict judge(const CsgTree& merged) const;

 private:
  std::vector<MergeWindow> windows_;
  double alpha_;
  RunContext run_;
  std::vector<double> promised_;  // by primitive
};

/// A connected component of the overlap graph and its partitions' trees, in the component's indices.
struct Component {
  std::size_t primitives = 0;             ///< how many
  std::vector<MergeWindow> windows = {};  ///< one over all primitives, or some for each
  double alpha = 0;                       ///< cost of a node
  std::vector<Clique> cliques = {};
  std::vector<CsgTree> trees = {};  ///< one for each clique
};

/// Finds the tree of a set of primitives from their points, in the component's indices.
using SolveJointly = std::function<CsgTree(const Clique&)>;

/// The share of what its partitions reached that a primitive's surface may lose. Trees that agree differ by a few per
/// mille, near edges where one partition does not see the other's primitives.
inline constexpr double k_tolerated_shortfall = 0.05;

struct ComponentOptions {
  const GaOptions& search;
  bool polish;
  std::uint64_t item;  ///< tells the component's random streams apart from the partitions'
};

/// Merges the trees of a component: by the paper's merge, if it goes through and keeps the promises; else by dominance,
/// by largest common subtrees, by joint solutions of partitions that block each other, or by a search over the whole
/// component if that is not too large. Returns the best tree met, so there always is one. Fills in `statistics`' way.
struct MergedComponent {
  CsgTree tree;
  MergeStatistics statistics;  ///< with one entry in ways
  bool complete = true;
};
[[nodiscard]] MergedComponent merge_component(const Component& component, const SolveJointly& solve_jointly,
                                              const ComponentOptions& options, const RunContext& run);

}  // namespace cloud2csg
