#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {

/// The costs of labels, in points: see cost_of().
class LabelCosts {
 public:
  /// More than any cloud has points.
  static constexpr double k_forbidden = 1e12;

  /// Two cells that meet where nothing was seen, and the cost when only one of them is in the solid.
  struct Border {
    CellIndex first, second;
    double cost;
  };

  LabelCosts(const CellComplex& complex, double density, const LabelOptions& options)
      : if_in_(complex.cells.size()), if_out_(complex.cells.size()) {
    for (const Patch& patch : complex.patches) {
      if_out_[patch.first] += patch.first_in / 2;
      if_in_[patch.second] += patch.first_in / 2;
      if_out_[patch.second] += patch.second_in / 2;
      if_in_[patch.first] += patch.second_in / 2;
      const double missing =
          options.absence * density * patch.area - options.presence * (patch.first_in + patch.second_in);
      if (missing > 0) borders_.push_back({patch.first, patch.second, missing});
    }
    for (CellIndex cell = 0; cell < complex.seen_through.size(); ++cell) {
      if_in_[cell] += options.sight * complex.seen_through[cell];
    }
  }

  /// The costs of some cells, by their places in `cells`, for fixed labels of the others.
  [[nodiscard]] LabelCosts of_part(std::span<const CellIndex> cells, const std::vector<bool>& is_in) const {
    constexpr auto k_none = static_cast<CellIndex>(-1);
    std::vector<CellIndex> place(if_in_.size(), k_none);
    LabelCosts part;
    for (const CellIndex cell : cells) {
      place[cell] = static_cast<CellIndex>(part.if_in_.size());
      part.if_in_.push_back(if_in_[cell]);
      part.if_out_.push_back(if_out_[cell]);
    }
    for (const Border& border : borders_) {
      const CellIndex first = place[border.first];
      const CellIndex second = place[border.second];
      if (first != k_none && second != k_none) {
        part.borders_.push_back({first, second, border.cost});
      } else if (first != k_none) {
        part.add(first, !is_in[border.second], border.cost);
      } else if (second != k_none) {
        part.add(second, !is_in[border.first], border.cost);
      }
    }
    return part;
  }

  /// Adds a cell of which nothing is known. Returns its index.
  CellIndex add_cell() {
    if_out_.push_back(0);
    if_in_.push_back(0);
    return static_cast<CellIndex>(if_in_.size() - 1);
  }
  /// Adds to the cost of the cell in the solid, or out of it.
  void add(CellIndex cell, bool is_in, double cost) { (is_in ? if_in_ : if_out_)[cell] += cost; }

  [[nodiscard]] double if_in(CellIndex cell) const { return if_in_[cell]; }
  [[nodiscard]] double if_out(CellIndex cell) const { return if_out_[cell]; }
  [[nodiscard]] std::size_t cells() const { return if_in_.size(); }
  [[nodiscard]] const std::vector<Border>& borders() const { return borders_; }

  /// The cost of all labels. `is_in(cell)`: whether it is in the solid. O(cells + borders)
  template <class IsIn>
  [[nodiscard]] double of(const IsIn& is_in) const {
    double sum = 0;
    for (CellIndex cell = 0; cell < if_in_.size(); ++cell) sum += is_in(cell) ? if_in_[cell] : if_out_[cell];
    for (const Border& border : borders_) {
      if (is_in(border.first) != is_in(border.second)) sum += border.cost;
    }
    return sum;
  }

 private:
  LabelCosts() = default;

  std::vector<double> if_in_, if_out_;
  std::vector<Border> borders_;
};

}  // namespace cloud2csg
