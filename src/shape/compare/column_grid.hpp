#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Parallel lines through a box, on a square lattice across its shortest side. The golden section is the tangent of the
/// lattice's angle. Few walls of real parts align with it, so the error of an area falls almost with the number of
/// columns instead of its root. Deterministic: equal boxes give equal grids.
class ColumnGrid {
 public:
  /// About resolution^2 columns. Precondition: `box` is finite and not empty.
  ColumnGrid(const AlignedBox& box, int resolution);

  [[nodiscard]] std::size_t size() const { return columns_.size(); }
  [[nodiscard]] double spacing() const { return spacing_; }
  /// Depths along the columns that enclose the box with some room.
  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }

  /// A point on a column, in world coordinates.
  [[nodiscard]] Eigen::Vector3d point(std::size_t column, double depth) const {
    return centre_ + frame_ * Eigen::Vector3d(columns_[column].x(), columns_[column].y(), depth);
  }
  /// Two lattice coordinates, then the depth.
  [[nodiscard]] Eigen::Vector3d to_lattice(const Eigen::Vector3d& world) const;

  static constexpr std::int32_t k_no_column = -1;
  /// The column at a node of the lattice, or k_no_column.
  [[nodiscard]] std::int32_t column_at(std::int64_t i, std::int64_t j) const {
    return i < 0 || j < 0 || i >= width_ || j >= height_ ? k_no_column
                                                         : index_[static_cast<std::size_t>(j * width_ + i)];
  }
  [[nodiscard]] std::int64_t width() const { return width_; }
  [[nodiscard]] std::int64_t height() const { return height_; }

 private:
  Eigen::Vector3d centre_;
  Eigen::Matrix3d frame_;  ///< columns: the two lattice directions and the depth direction
  Eigen::Vector2d corner_;
  double spacing_ = 0.0;
  double low_ = 0.0, high_ = 0.0;
  std::int64_t width_ = 0, height_ = 0;
  std::vector<std::int32_t> index_;
  std::vector<Eigen::Vector2d> columns_;
};

/// Depths at which consecutive columns enter and leave a solid.
struct ColumnCuts {
  std::vector<double> depths;            ///< in, out, in, out... ascending, column after column
  std::vector<std::size_t> first = {0};  ///< column c has depths[first[c]] up to depths[first[c + 1]]

  [[nodiscard]] std::span<const double> of(std::size_t column) const {
    return std::span(depths).subspan(first[column], first[column + 1] - first[column]);
  }
};

/// Cuts of columns first .. first + count - 1 with a solid. Searches between two samples of the same sign as long as
/// the slope allows a cut there and the gap is not far below the spacing. Cuts are accurate to 1e-8 of the depth.
/// Precondition: the solid lies in the grid's box.
class ModelColumns {
 public:
  ModelColumns(const Model& model, const ColumnGrid& grid);
  [[nodiscard]] ColumnCuts cuts(std::size_t first, std::size_t count) const;

 private:
  struct Piece;
  struct Cut;
  [[nodiscard]] std::vector<double> values_at(const Points& places) const;
  [[nodiscard]] bool may_have_cuts(const Piece& piece) const;
  [[nodiscard]] std::vector<Piece> first_pieces(std::size_t first, std::size_t count) const;
  /// Splits the pieces. Adds narrow cuts to `found` and returns pieces that need more refinement.
  [[nodiscard]] std::vector<Piece> refine(const std::vector<Piece>& pieces, std::vector<Cut>& found) const;

  const CsgTree& tree_;
  const PrimitiveSet& primitives_;
  const ColumnGrid& grid_;
  double steepest_;      ///< Lipschitz constant of the tree's implicit value; an estimate for expressions
  double smallest_gap_;  ///< shorter pieces are not searched for pairs of cuts
};

/// The exact cuts with a mesh. Overlapping shells of a well-formed mesh count once; otherwise parity decides.
class MeshColumns {
 public:
  MeshColumns(const TriangleMesh& mesh, const ColumnGrid& grid, const RunContext& run);
  [[nodiscard]] ColumnCuts cuts(std::size_t first, std::size_t count) const;
  /// Columns that enter without leaving, because the mesh has holes. Their last, unmatched cut is dropped.
  [[nodiscard]] std::size_t open_columns() const { return open_columns_; }

 private:
  ColumnCuts all_;
  std::size_t open_columns_ = 0;
};

}  // namespace cloud2csg
