#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/quadric.hpp"
#include "mesh/surface_cells.hpp"

namespace cloud2csg {

/// One quadrilateral for each crossed grid edge, around that edge.
struct Quad {
  std::array<std::uint32_t, 4> vertices;  ///< counter-clockwise seen from outside
};

/// The mesh before its vertices are placed.
struct Contour {
  std::vector<Quadric> quadrics;         ///< by vertex: the tangent planes on the edges of its sheet
  std::vector<std::vector<Quad>> quads;  ///< by block
};

/// Finds all crossings and sorts them into sheets and quads. @throws Cancelled
[[nodiscard]] Contour trace_contour(const SparseField& field, const SurfaceCells& cells, const PrimitiveSet& primitives,
                                    const RunContext& run);

/// Positions of the vertices, in grid coordinates: on the surface, and on its edges and corners where the sheet has
/// one. No two vertices have the same position.
/// @throws Cancelled
[[nodiscard]] std::vector<Eigen::Vector3d> place_vertices(const SparseField& field, const SurfaceCells& cells,
                                                          const PrimitiveSet& primitives, const Contour& contour,
                                                          const RunContext& run);

}  // namespace cloud2csg
