#pragma once

#include <span>

#include "cells/take_apart.hpp"
#include "cloud2csg/advanced/cells.hpp"

/// Local searches for trees whose cells and leaves cost less, on the cells instead of points. Labels that are sure at
/// every limit of options.least_evidence stay, and so do the cells that reach to infinity. All trees are over the set's
/// indices. Deterministic; a triggered run.stop ends them soon.
namespace cloud2csg {

/// The best of the searches from each of `starts`, of which there is one, over all cells.
/// O(size x cells / 64 + cells + patches) an evaluation.
[[nodiscard]] CsgTree climb_as_whole(const CellComplex& complex, const CellLabels& labels,
                                     std::span<const CsgTree> starts, const CellSolveOptions& options,
                                     const RunContext& run);

/// A solid's cores with their trees, and how many leaves each needs at least.
struct SolvedCores {
  TakenApart parts;
  std::vector<CsgTree> trees = {};
  std::vector<std::size_t> least_leaves = {};
};

/// Climbs core by core, the rest being what it is, over the cells that the core decides: from its own tree, and what
/// `others`, trees of the whole, are over its primitives alone. Not where a core's tree is as small as it can be.
/// O(size x cells of the core / 64 + its cells and patches) an evaluation.
[[nodiscard]] CsgTree climb_core_by_core(const CellComplex& complex, const CellLabels& labels, SolvedCores cores,
                                         std::span<const CsgTree> others, const CellSolveOptions& options,
                                         const RunContext& run);

}  // namespace cloud2csg
