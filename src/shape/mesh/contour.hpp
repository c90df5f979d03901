#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "shape/mesh/surface_cells.hpp"

namespace cloud2csg {

/// A sum of squared distances to tangent planes of the surface, in grid coordinates.
class Quadric {
 public:
  /// Adds the plane through `point` with unit `normal`.
  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    const double offset = normal.dot(point);
    matrix_ += normal * normal.transpose();
    vector_ += offset * normal;
    constant_ += offset * offset;
    point_sum_ += point;
    count_ += 1;
  }
  void add(const Quadric& other) {
    matrix_ += other.matrix_;
    vector_ += other.vector_;
    constant_ += other.constant_;
    point_sum_ += other.point_sum_;
    count_ += other.count_;
  }

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// Mean of the planes' points. Precondition: not empty.
  [[nodiscard]] Eigen::Vector3d mean_point() const { return point_sum_ / count_; }
  /// Root mean square distance of x to the planes.
  [[nodiscard]] double residual(const Eigen::Vector3d& x) const;

  struct Minimum {
    Eigen::Vector3d point;
    int rank;          ///< rank of the normals: 1 on a smooth surface, 2 on a sharp edge, 3 at a corner
    double sharpness;  ///< ratio of the least eigenvalue to the largest: clarity of a corner
  };
  /// The minimum nearest to the mean point. Eigenvalues below `cutoff` times the largest count as zero.
  [[nodiscard]] Minimum minimum(double cutoff) const;
  [[nodiscard]] Eigen::Vector3d minimum_within(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const;

 private:
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector_ = Eigen::Vector3d::Zero();
  double constant_ = 0;
  Eigen::Vector3d point_sum_ = Eigen::Vector3d::Zero();
  double count_ = 0;
};

/// A quadrilateral around a crossed grid edge.
struct Quad {
  std::array<std::uint32_t, 4> vertices;  ///< counter-clockwise seen from outside
};

/// The mesh before its vertices are placed.
struct Contour {
  std::vector<Quadric> quadrics;         ///< by vertex: tangent planes on the edges of its sheet
  std::vector<std::vector<Quad>> quads;  ///< by block
};

/// Finds all crossings and sorts them into sheets and quads. @throws Cancelled
[[nodiscard]] Contour trace_contour(const SparseField& field, const SurfaceCells& cells, const PrimitiveSet& primitives,
                                    const RunContext& run);

/// Quality of a vertex's position. Lower kinds are given up first.
enum class VertexKind : std::uint8_t {
  outlying_edge,  ///< on a sharp edge, outside the vertex's own cell
  in_cell,        ///< in its cell, on the surface
  corner,         ///< on a corner of the solid
  mean,           ///< mean of the sheet's crossings: never tangled, but off a curved surface
};

struct Placement {
  std::vector<Eigen::Vector3d> positions;  ///< by vertex, in grid coordinates; all distinct
  std::vector<Eigen::Vector3d> in_cell;    ///< by vertex: the best position within its cell
  std::vector<VertexKind> kinds;           ///< by vertex
};

/// Places the vertices on the surface, and on sharp edges and corners of their sheets. @throws Cancelled
[[nodiscard]] Placement place_vertices(const SparseField& field, const SurfaceCells& cells,
                                       const PrimitiveSet& primitives, const Contour& contour, const RunContext& run);

}  // namespace cloud2csg
