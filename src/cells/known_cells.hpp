#pragma once

#include <unordered_set>
#include <vector>

#include "cells/cell_hash.hpp"
#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {

/// A cell of which it is sure whether it is in the solid.
struct KnownCell {
  Cell cell;
  bool is_in = false;
  bool is_open = true;  ///< no primitive that was split off decides it
};

/// The sure cells and the one outside of all, without primitives on which no label depends. Where the cell outside of
/// all is in the solid, all labels are taken for their opposite.
class KnownCells {
 public:
  /// O(size of all cells)
  KnownCells(const CellComplex& complex, const CellLabels& labels, double least_evidence);
  KnownCells(const KnownCells&) = delete;
  KnownCells& operator=(const KnownCells&) = delete;
  KnownCells(KnownCells&&) = delete;
  KnownCells& operator=(KnownCells&&) = delete;
  ~KnownCells() = default;

  /// Leaves none behind.
  [[nodiscard]] std::vector<KnownCell> take_sorted();

  /// How many primitives any tree needs, if the cell outside of all is sure.
  [[nodiscard]] std::size_t essential() const { return essential_; }
  /// Whether that is all that have cells.
  [[nodiscard]] bool are_all_essential() const { return left_out_ == 0; }

 private:
  /// The index holds places in cells_, and is asked for cells.
  struct Hash {
    using is_transparent = void;
    const KnownCells* known;
    std::size_t operator()(std::size_t place) const { return CellHash()(known->cells_[place].cell); }
    std::size_t operator()(const Cell& cell) const { return CellHash()(cell); }
  };
  struct Equal {
    using is_transparent = void;
    const KnownCells* known;
    bool operator()(std::size_t a, std::size_t b) const { return known->cells_[a].cell == known->cells_[b].cell; }
    bool operator()(std::size_t place, const Cell& cell) const { return known->cells_[place].cell == cell; }
    bool operator()(const Cell& cell, std::size_t place) const { return known->cells_[place].cell == cell; }
  };

  [[nodiscard]] bool is_needed(PrimitiveIndex p) const;
  void leave_out(PrimitiveIndex p);

  std::vector<KnownCell> cells_;
  std::vector<std::vector<std::size_t>> cells_of_;  // by primitive
  std::unordered_set<std::size_t, Hash, Equal> index_;
  std::size_t essential_ = 0, left_out_ = 0;
};

}  // namespace cloud2csg
