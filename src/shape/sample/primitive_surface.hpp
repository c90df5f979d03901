#pragma once

#include "cloud2csg/run_context.hpp"
#include "core/primitive/surface_points.hpp"

namespace cloud2csg {

/// Closed forms for every plain shape; a half-space gives the part of its plane around `region` (finite). Expressions
/// and displaced solids are meshed finely and drawn by the mesh's area: uniform as far as the mesh has the area of the
/// surface. That takes a tenth of a second each; where thousands are sampled that need not be quite uniform, see
/// sample_surfaces() of the cells. @throws Cancelled
[[nodiscard]] PrimitiveSurface make_surface(const Primitive& primitive, const AlignedBox& region,
                                            const RunContext& run);

}  // namespace cloud2csg
