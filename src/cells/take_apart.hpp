#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cells/decompose.hpp"
#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {

/// Primitives that were split off at once: all united with the rest, or all taken from it.
struct PeeledRound {
  bool are_in;
  std::vector<PrimitiveIndex> primitives;  ///< ascending
};

/// Primitives that share sure cells which nothing that was split off decides.
struct Core {
  std::vector<PrimitiveIndex> primitives;  ///< ascending
  KnownRows rows;                          ///< of these cells, over the places in `primitives`; none is off, too
};

/// A solid as what is split off from the union of its cores. What no sure label depends on is in none of these.
struct TakenApart {
  bool is_inverted = false;              ///< it is the complement of that
  std::vector<PeeledRound> rounds = {};  ///< the outermost first
  std::vector<Core> cores = {};          ///< no primitive is in two of them
  std::size_t essential = 0;             ///< so many primitives are in any tree with these labels
  bool are_all_essential = true;         ///< that is all that have sure cells: none was left out
  bool is_outside_sure = true;           ///< the cell outside of all primitives, which is taken to be off

  /// Whether any tree with the sure labels has the leaves that each core needs, and one of each that was split off.
  [[nodiscard]] bool needs_its_parts() const { return are_all_essential && is_outside_sure; }
  /// How many any tree needs in any case.
  [[nodiscard]] std::size_t least_leaves() const { return is_outside_sure ? essential : 0; }
};

/// From the cells that are sure. Absent when a core has more than k_most_variables primitives. O(size of all cells)
[[nodiscard]] std::optional<TakenApart> take_apart(const CellComplex& complex, const CellLabels& labels,
                                                   double least_evidence);

/// The same without leaving out or splitting off anything: cores that any tree must be right on. Absent as above.
[[nodiscard]] std::optional<TakenApart> take_apart_only(const CellComplex& complex, const CellLabels& labels,
                                                        double least_evidence);

/// The solid with a tree for each core, over the set's indices; simplified.
[[nodiscard]] CsgTree put_together(const TakenApart& parts, std::span<const CsgTree> of_cores);

}  // namespace cloud2csg
