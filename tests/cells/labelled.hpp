#pragma once

#include <limits>
#include <optional>
#include <set>
#include <vector>

#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {

inline constexpr double k_noise = 0.01;
inline constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// Cells and what they are.
struct Labelled {
  CellComplex complex;
  CellLabels labels;

  [[nodiscard]] std::optional<CellSolution> solve(const CellSolveOptions& options = {}) const {
    return solve_cells(complex, labels, options);
  }
};

inline Labelled label(const PointCloud& cloud, const PrimitiveSet& primitives) {
  Labelled result{find_cells(cloud, primitives, {.tolerances = segmentation_tolerances({}, k_noise), .noise = k_noise}),
                  {}};
  result.labels = label_cells(result.complex);
  return result;
}

inline bool is_in(const CsgTree& tree, const Cell& cell, std::size_t primitives) {
  std::vector<bool> inside(primitives);
  for (const PrimitiveIndex p : cell) inside[p] = true;
  return contains(tree, inside);
}

/// Cells by hand, the one outside of all among them, with the labels of a tree, all of them sure.
inline Labelled labelled_by(const CsgTree& truth, const std::set<Cell>& cells, std::size_t primitives) {
  Labelled result;
  result.complex.cells.assign(cells.begin(), cells.end());
  result.complex.points_of_primitive.assign(primitives, 1);
  for (const Cell& cell : cells) {
    result.labels.is_in.push_back(is_in(truth, cell, primitives));
    result.labels.evidence.push_back(cell.empty() ? k_infinity : 100.0);
  }
  return result;
}

inline bool has_labels(const CsgTree& tree, const Labelled& labelled, double least_evidence) {
  for (std::size_t c = 0; c < labelled.complex.cells.size(); ++c) {
    if (labelled.labels.evidence[c] < least_evidence) continue;
    const bool in_tree = is_in(tree, labelled.complex.cells[c], labelled.complex.points_of_primitive.size());
    if (in_tree != labelled.labels.is_in[c]) return false;
  }
  return true;
}

}  // namespace cloud2csg
