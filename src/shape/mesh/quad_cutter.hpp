#pragma once

#include <array>
#include <span>
#include <vector>

#include "shape/mesh/contour.hpp"

namespace cloud2csg {

using Triangle = std::array<std::uint32_t, 3>;

/// Cuts the quads of one block into triangles, each along the diagonal that follows the surface: where a sharp edge
/// runs through a quad, that is the one on the edge. `positions`: of all vertices, in grid coordinates.
class QuadCutter {
 public:
  QuadCutter(const Grid& grid, const CsgTree& tree, const PrimitiveSet& primitives,
             std::span<const Eigen::Vector3d> positions)
      : grid_(grid), tree_(tree), primitives_(primitives), positions_(positions) {}

  struct Result {
    std::vector<Triangle> triangles;
    std::vector<Triangle> folded;  ///< those of them that look the wrong way
  };
  [[nodiscard]] Result cut(std::span<const Quad> quads) const;

 private:
  /// The two triangles on the diagonal from corner 0 (or 1) of a quad.
  struct Cut {
    std::array<Triangle, 2> triangles;
    std::array<Eigen::Vector3d, 2> normals;  ///< unit length; zero for a triangle without area
  };

  [[nodiscard]] Cut cut_from(const Quad& quad, std::size_t start) const;
  [[nodiscard]] Eigen::Vector3d normal_of(const Triangle& triangle) const;
  [[nodiscard]] Eigen::Vector3d centroid_of(const Triangle& triangle) const;
  [[nodiscard]] double squared_diagonal(const Quad& quad, std::size_t start) const;
  [[nodiscard]] std::vector<double> alignments(std::span<const Cut> cuts) const;
  [[nodiscard]] bool is_flat(const std::array<Cut, 2>& cuts) const;

  const Grid& grid_;
  const CsgTree& tree_;
  const PrimitiveSet& primitives_;
  std::span<const Eigen::Vector3d> positions_;
};

}  // namespace cloud2csg
