#pragma once

#include <functional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/extract.hpp"
#include "paper/merge/merge_check.hpp"

namespace cloud2csg {

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
