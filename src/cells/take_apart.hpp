#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cells/decompose.hpp"
#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {

/// Primitives that were split off at once: all united with the rest, or all subtracted from it.
struct PeeledRound {
  bool are_in;
  std::vector<PrimitiveIndex> primitives;  ///< ascending
};

/// Primitives that share sure cells which no peeled primitive decides.
struct Core {
  std::vector<PrimitiveIndex> primitives;  ///< ascending
  KnownRows rows;                          ///< these cells over the places in `primitives`; the empty row is off
};

/// A solid as primitives split off from the union of its cores. Primitives that no sure label depends on are left out.
struct TakenApart {
  bool is_inverted = false;              ///< the solid is the complement of that
  std::vector<PeeledRound> rounds = {};  ///< outermost first
  std::vector<Core> cores = {};          ///< no primitive is in two of them
  std::size_t essential = 0;             ///< number of primitives that any tree with these labels has
  bool are_all_essential = true;         ///< all primitives with sure cells are essential: none was left out
  bool is_outside_sure = true;           ///< the cell outside of all primitives is sure; it is taken to be off

  /// Whether any tree with the sure labels has the leaves that each core needs, and one for each peeled primitive.
  [[nodiscard]] bool needs_its_parts() const { return are_all_essential && is_outside_sure; }
  /// The number of leaves that any tree needs in any case.
  [[nodiscard]] std::size_t least_leaves() const { return is_outside_sure ? essential : 0; }
};

/// Takes the sure cells. Absent when a core has more than k_most_variables primitives. O(size of all cells)
[[nodiscard]] std::optional<TakenApart> take_apart(const CellComplex& complex, const CellLabels& labels,
                                                   double least_evidence);

/// As take_apart(), but leaves out and splits off nothing: any tree must be right on the cores. Absent as above.
[[nodiscard]] std::optional<TakenApart> take_apart_only(const CellComplex& complex, const CellLabels& labels,
                                                        double least_evidence);

/// The solid with a tree for each core, over the set's indices; simplified.
[[nodiscard]] CsgTree put_together(const TakenApart& parts, std::span<const CsgTree> of_cores);

}  // namespace cloud2csg
