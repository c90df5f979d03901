#pragma once

#include <cstdint>
#include <vector>

#include "shape/mesh/cell_topology.hpp"
#include "shape/mesh/sparse_field.hpp"

namespace cloud2csg {

struct SurfaceCell {
  Eigen::Vector3i cell;
  CornerSigns signs;
  FaceMask joined = 0;  ///< see loops_of()
  Loops loops = {};
  std::uint32_t first_vertex = 0;  ///< one vertex for each loop, in their order
};

/// All surface cells, with one vertex for each sheet in each cell. Joined across the crossed grid edges, the vertices
/// form a closed 2-manifold: two triangles at every edge, one fan at every vertex.
///
/// Two cells share at most one face. So a mesh edge could have more than two triangles only if both curves through an
/// ambiguous face belong to one sheet in either cell. Joining that face's corners the other way splits both sheets.
/// Splitting never merges curves into one sheet, so one pass over the faces repairs all.
class SurfaceCells {
 public:
  SurfaceCells(const SparseField& field, const BoundedSolid& solid);

  [[nodiscard]] const std::vector<SurfaceCell>& cells() const { return cells_; }
  /// The cells that the block at `slot` owns.
  [[nodiscard]] std::span<const SurfaceCell> cells_of_block(std::size_t slot) const {
    return std::span(cells_).subspan(block_begin_[slot], block_begin_[slot + 1] - block_begin_[slot]);
  }
  [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }
  /// Null if the surface does not cross the cell.
  [[nodiscard]] const SurfaceCell* find(const Eigen::Vector3i& cell) const;
  /// The vertex of the sheet that crosses an edge of a cell. Precondition: the edge is crossed.
  [[nodiscard]] std::uint32_t vertex_at(const Eigen::Vector3i& cell, int edge) const;

 private:
  void collect_cells();
  void join_faces(const BoundedSolid& solid);
  void number_vertices();

  const SparseField& field_;
  std::vector<SurfaceCell> cells_;
  std::vector<std::size_t> block_begin_;  ///< by slot, and the end
  std::vector<std::uint32_t> cell_at_;    ///< by slot and local index: position in cells_, or k_no_cell
  std::size_t vertex_count_ = 0;
};

}  // namespace cloud2csg
