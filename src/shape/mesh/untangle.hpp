#pragma once

#include <span>
#include <vector>

#include "shape/mesh/contour.hpp"
#include "shape/mesh/quad_cutter.hpp"

namespace cloud2csg {

struct Untangled {
  std::vector<Eigen::Vector3d> positions;  ///< by vertex, in grid coordinates
  std::vector<Triangle> triangles;
};

/// Cuts all quads into triangles. Where vertices on sharp edges got ahead of each other and a triangle looks the wrong
/// way, they go back a step, from the edge into their cells and from there to the middle of their crossings, until
/// none does or nothing is left to give. Vertices at corners of the solid give way last, or not at all if
/// `corners_first`. @throws Cancelled
[[nodiscard]] Untangled cut_untangled(const SparseField& field, const PrimitiveSet& primitives, const Contour& contour,
                                      Placement placement, bool corners_first, const RunContext& run);

}  // namespace cloud2csg
