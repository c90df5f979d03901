#include "shape/mesh/contour.hpp"

#include "core/base/parallel.hpp"
#include "shape/mesh/edge_crossings.hpp"

namespace cloud2csg {
namespace {

/// The four cells around an edge in the order in which they turn around its axis, and which of their edges it is.
Quad quad_around(const Crossing& crossing, const SurfaceCells& cells) {
  constexpr std::array<std::array<int, 2>, 4> k_steps = {{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
  const int u = (crossing.axis + 1) % 3;
  const int v = (crossing.axis + 2) % 3;
  Quad quad = {};
  for (std::size_t i = 0; i < 4; ++i) {
    Eigen::Vector3i cell = crossing.corner;
    cell[u] += k_steps[i][0];
    cell[v] += k_steps[i][1];
    const int edge = 4 * crossing.axis - k_steps[i][0] - 2 * k_steps[i][1];
    // Seen from the outside end of the edge the cells turn counter-clockwise.
    quad.vertices[crossing.from_inside ? i : 3 - i] = cells.vertex_at(cell, edge);
  }
  return quad;
}

bool owns(const Block& block, const Eigen::Vector3i& corner) {
  return ((corner - block.first_cell).array() < k_block_cells).all();
}

}  // namespace

Contour trace_contour(const SparseField& field, const SurfaceCells& cells, const PrimitiveSet& primitives,
                      const RunContext& run) {
  Contour contour{.quadrics = std::vector<Quadric>(cells.vertex_count()),
                  .quads = std::vector<std::vector<Quad>>(field.blocks().size())};
  for_each_index(field.blocks().size(), run, [&](std::size_t slot) {
    const Block& block = field.blocks()[slot];
    const std::span<const SurfaceCell> block_cells = cells.cells_of_block(slot);
    if (block_cells.empty()) return;
    const BlockCrossings crossings(block, field.grid(), block_cells, primitives);
    for (const SurfaceCell& cell : block_cells) {
      const EdgeMask crossed = crossed_edges(cell.signs);
      for (int edge = 0; edge < k_cell_edges; ++edge) {
        if (((crossed >> edge) & 1) == 0) continue;
        const Crossing& crossing = crossings.at(cell, edge);
        contour.quadrics[cell.first_vertex + static_cast<std::uint32_t>(cell.loops.loop_of(edge))].add(crossing.point,
                                                                                                       crossing.normal);
      }
    }
    for (const Crossing& crossing : crossings.all()) {
      if (owns(block, crossing.corner)) contour.quads[slot].push_back(quad_around(crossing, cells));
    }
  });
  return contour;
}

}  // namespace cloud2csg
