#pragma once

#include <vector>

#include "shape/mesh/surface_cells.hpp"

namespace cloud2csg {

/// Where the surface crosses a grid edge.
struct Crossing {
  Eigen::Vector3i corner;  ///< lower end of the edge
  int axis;
  bool from_inside;        ///< whether the lower end is the inside one
  Eigen::Vector3d point;   ///< grid coordinates
  Eigen::Vector3d normal;  ///< outward, unit length
};

/// The crossings on the edges of a block's surface cells, those on its far sides included: each edge once, and where
/// to find it.
class BlockCrossings {
 public:
  BlockCrossings(const Block& block, const Grid& grid, std::span<const SurfaceCell> cells,
                 const PrimitiveSet& primitives);

  [[nodiscard]] std::span<const Crossing> all() const { return crossings_; }
  /// Precondition: the edge of the cell is crossed.
  [[nodiscard]] const Crossing& at(const SurfaceCell& cell, int edge) const;

 private:
  [[nodiscard]] std::size_t position(const SurfaceCell& cell, int edge) const;

  Eigen::Vector3i first_cell_;
  std::vector<Crossing> crossings_;
  std::vector<int> index_;  ///< by local corner and axis: position in crossings_, or -1
};

}  // namespace cloud2csg
