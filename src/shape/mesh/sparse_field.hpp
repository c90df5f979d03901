#pragma once

#include <Eigen/Core>
#include <array>
#include <bitset>
#include <cstdint>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// A finite solid for a grid. Each value is a known Lipschitz function or known to be outside.
struct BoundedSolid {
  CsgTree tree = {};
  PrimitiveSet primitives = {};
  AlignedBox bounds;  ///< finite, encloses the solid; empty for an empty solid
};

/// Cuts the solid at `bounds`, and expressions at their own bounds, beyond which their formula has no meaning. @throws
/// Error when neither the solid nor `bounds` is finite.
[[nodiscard]] BoundedSolid bound_solid(const Model& model, const AlignedBox& bounds);

/// Cells along each edge of a block.
constexpr int k_block_cells = 8;
/// Corners along each edge of a block.
constexpr int k_layer = k_block_cells + 1;
constexpr int k_block_corners = k_block_cells * k_block_cells * k_block_cells;
/// A block's tree is valid this many cells beyond the block.
constexpr int k_block_reach = 2;

/// A regular grid. "Grid coordinates" count cells from its origin, so cell (i, j, k) is the unit cube at (i, j, k).
struct Grid {
  Eigen::Vector3d origin;
  double spacing;
  Eigen::Vector3i blocks;  ///< number along each axis

  [[nodiscard]] Eigen::Vector3d to_world(const Eigen::Vector3d& p) const { return origin + spacing * p; }
};

/// 8 x 8 x 8 cells near the surface, by their lower corners.
struct Block {
  Eigen::Vector3i first_cell;
  CsgTree tree;                         ///< same values as the whole tree in and near the block
  std::bitset<k_block_corners> inside;  ///< signs at the corners: x + 8 y + 64 z

  [[nodiscard]] static int local_index(const Eigen::Vector3i& cell) {
    return cell.x() + k_block_cells * (cell.y() + k_block_cells * cell.z());
  }
};

/// The signs of a solid on a grid. Stores only blocks that the surface may cross, O(resolution^2).
class SparseField {
 public:
  /// Margins keep outermost corners outside. Irrational shifts of the grid keep faces of models off grid planes.
  SparseField(const BoundedSolid& solid, int resolution, const RunContext& run);

  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }
  /// Position in blocks() of the block that owns a cell; negative for a block wholly inside or outside.
  [[nodiscard]] int slot_of(const Eigen::Vector3i& cell) const {
    return slots_[slot_position((cell.array() / k_block_cells).matrix())];
  }
  [[nodiscard]] bool inside(const Eigen::Vector3i& corner) const;

 private:
  class Subdivision;
  static constexpr int k_all_outside = -1;
  static constexpr int k_all_inside = -2;

  [[nodiscard]] std::size_t slot_position(const Eigen::Vector3i& block) const {
    const Eigen::Matrix<std::size_t, 3, 1> at = block.cast<std::size_t>();
    const Eigen::Matrix<std::size_t, 3, 1> size = grid_.blocks.cast<std::size_t>();
    return at.x() + size.x() * (at.y() + size.y() * at.z());
  }

  Grid grid_;
  std::vector<Block> blocks_;
  std::vector<int> slots_;  ///< for every block of the grid, stored or not
};

}  // namespace cloud2csg
