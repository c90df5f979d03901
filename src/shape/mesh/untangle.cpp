#include "shape/mesh/untangle.hpp"

#include <algorithm>
#include <utility>

#include "core/base/parallel.hpp"

namespace cloud2csg {
namespace {

/// Gives up the least of what the triangle's vertices have, if it is less than `limit`; false when nothing is.
bool relax(const Triangle& triangle, const Contour& contour, VertexKind limit, Placement& placement,
           std::vector<bool>& moved) {
  VertexKind weakest = limit;
  for (const std::uint32_t vertex : triangle) weakest = std::min(weakest, placement.kinds[vertex]);
  if (weakest == limit) return false;
  for (const std::uint32_t vertex : triangle) {
    if (placement.kinds[vertex] != weakest) continue;
    const bool to_mean = weakest == VertexKind::in_cell || placement.positions[vertex] == placement.in_cell[vertex];
    placement.positions[vertex] = to_mean ? contour.quadrics[vertex].mean_point() : placement.in_cell[vertex];
    placement.kinds[vertex] = to_mean ? VertexKind::mean : VertexKind::in_cell;
    moved[vertex] = true;
  }
  return true;
}

bool touches(std::span<const Quad> quads, const std::vector<bool>& moved) {
  return std::any_of(quads.begin(), quads.end(), [&moved](const Quad& quad) {
    return std::any_of(quad.vertices.begin(), quad.vertices.end(), [&moved](std::uint32_t v) { return moved[v]; });
  });
}

}  // namespace

Untangled cut_untangled(const SparseField& field, const PrimitiveSet& primitives, const Contour& contour,
                        Placement placement, bool corners_first, const RunContext& run) {
  constexpr int k_most_rounds = 8;
  const VertexKind limit = corners_first ? VertexKind::corner : VertexKind::mean;
  std::vector<QuadCutter::Result> cuts(field.blocks().size());
  std::vector<bool> moved(placement.positions.size(), true);
  for (int round = 0; round < k_most_rounds; ++round) {
    for_each_index(cuts.size(), run, [&](std::size_t slot) {
      if (!touches(contour.quads[slot], moved)) return;
      const QuadCutter cutter(field.grid(), field.blocks()[slot].tree, primitives, placement.positions);
      cuts[slot] = cutter.cut(contour.quads[slot]);
    });
    std::fill(moved.begin(), moved.end(), false);
    bool any = false;
    for (const QuadCutter::Result& cut : cuts) {
      for (const Triangle& triangle : cut.folded) any = relax(triangle, contour, limit, placement, moved) || any;
    }
    if (!any) break;
  }
  Untangled result{.positions = std::move(placement.positions), .triangles = {}};
  for (const QuadCutter::Result& cut : cuts) {
    result.triangles.insert(result.triangles.end(), cut.triangles.begin(), cut.triangles.end());
  }
  return result;
}

}  // namespace cloud2csg
