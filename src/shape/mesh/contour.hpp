#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shape/mesh/quadric.hpp"
#include "shape/mesh/surface_cells.hpp"

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

/// What is known of a vertex's position, from the first to be given up to the last.
enum class VertexKind : std::uint8_t {
  outlying_edge,  ///< on a sharp edge, outside the vertex's own cell
  in_cell,        ///< in its cell, on the surface
  corner,         ///< on a corner of the solid
  mean,           ///< the mean of the sheet's crossings: off the surface where that is curved, but never tangled
};

struct Placement {
  std::vector<Eigen::Vector3d> positions;  ///< by vertex, in grid coordinates; no two the same
  std::vector<Eigen::Vector3d> in_cell;    ///< by vertex: a position within its cell, as good as that allows
  std::vector<VertexKind> kinds;           ///< by vertex
};

/// Puts the vertices on the surface, and on its edges and corners where the sheet has one. @throws Cancelled
[[nodiscard]] Placement place_vertices(const SparseField& field, const SurfaceCells& cells,
                                       const PrimitiveSet& primitives, const Contour& contour, const RunContext& run);

}  // namespace cloud2csg
