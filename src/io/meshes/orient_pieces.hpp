#pragma once

#include <cstddef>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {

/// What was turned to make the triangles of a mesh agree on which side is outside.
struct TurnedTriangles {
  std::size_t disagreeing = 0;  ///< triangles that disagreed with most of their piece
  bool whole = false;           ///< the volume was negative then: all were turned
  std::size_t pieces = 0;       ///< after that, closed pieces that were inside out and no cavities
};

/// Turns triangles such that neighbours across an edge of two agree, as most of the area of their piece has it; all, if
/// the volume is negative then; and closed pieces whose own volume still is, but for those within another, which are
/// cavities. A piece hangs together by edges of two triangles each. One that is not orientable keeps edges that
/// disagree. O(triangles log triangles), and for each piece of negative volume its triangles times those around it.
TurnedTriangles orient_pieces(TriangleMesh& mesh);

}  // namespace cloud2csg
