#include "cells/known_cells.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace cloud2csg {
namespace {

Cell without(const Cell& cell, PrimitiveIndex primitive) {
  Cell rest = cell;
  std::erase(rest, primitive);
  return rest;
}

/// By the points on the patches between a cell that they hold and one that they do not.
std::vector<PrimitiveIndex> least_seen_first(const CellComplex& complex) {
  std::vector<double> seen(complex.points_of_primitive.size());
  Cell between;
  for (const Patch& patch : complex.patches) {
    between.clear();
    std::ranges::set_symmetric_difference(complex.cells[patch.first], complex.cells[patch.second],
                                          std::back_inserter(between));
    for (const PrimitiveIndex p : between) seen[p] += patch.first_in + patch.second_in;
  }
  std::vector<PrimitiveIndex> order(seen.size());
  std::iota(order.begin(), order.end(), PrimitiveIndex{0});
  std::ranges::stable_sort(order, {}, [&seen](PrimitiveIndex p) { return seen[p]; });
  return order;
}

}  // namespace

KnownCells::KnownCells(const CellComplex& complex, const CellLabels& labels, double least_evidence)
    : cells_of_(complex.points_of_primitive.size()), index_(complex.cells.size(), Hash{this}, Equal{this}) {
  for (CellIndex c = 0; c < complex.cells.size(); ++c) {
    // What is outside of all is as labelled in any case: it is what the rest is split off from.
    if (c > 0 && labels.evidence[c] < least_evidence) continue;
    for (const PrimitiveIndex p : complex.cells[c]) cells_of_[p].push_back(cells_.size());
    cells_.push_back({complex.cells[c], labels.is_in[c] != labels.is_in.front()});
  }
  for (std::size_t c = 0; c < cells_.size(); ++c) index_.insert(c);
  std::vector<bool> is_essential(cells_of_.size());
  for (PrimitiveIndex p = 0; p < cells_of_.size(); ++p) is_essential[p] = is_needed(p);
  essential_ = static_cast<std::size_t>(std::ranges::count(is_essential, true));
  // Those stay so, whatever else is left out.
  for (const PrimitiveIndex p : least_seen_first(complex)) {
    if (!is_essential[p] && !is_needed(p)) leave_out(p);
  }
}

std::vector<KnownCell> KnownCells::take_sorted() {
  std::erase_if(cells_, [](const KnownCell& known) { return !known.is_open; });
  std::ranges::sort(cells_, {}, &KnownCell::cell);
  return std::move(cells_);
}

/// Whether two cells differ in nothing but the primitive, and in their label.
bool KnownCells::is_needed(PrimitiveIndex p) const {
  return std::ranges::any_of(cells_of_[p], [&](std::size_t c) {
    if (!cells_[c].is_open) return false;
    const auto other = index_.find(without(cells_[c].cell, p));
    return other != index_.end() && cells_[*other].is_in != cells_[c].is_in;
  });
}

void KnownCells::leave_out(PrimitiveIndex p) {
  left_out_ += cells_of_[p].empty() ? 0 : 1;
  for (const std::size_t c : cells_of_[p]) {
    if (!cells_[c].is_open) continue;
    index_.erase(index_.find(c));
    std::erase(cells_[c].cell, p);
    // Not open: it has become the same as another.
    cells_[c].is_open = index_.insert(c).second;
  }
}

}  // namespace cloud2csg
