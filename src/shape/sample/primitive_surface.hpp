#pragma once

#include "cloud2csg/run_context.hpp"
#include "core/primitive/surface_points.hpp"

namespace cloud2csg {

/// Closed forms for all plain shapes; half-spaces and solids far larger than `region` (finite) give the part of their
/// surface around it. Expressions and displaced solids get a fine mesh, sampled uniformly by area, which takes a tenth
/// of a second each. For thousands that need not be quite uniform, see sample_surfaces() in cells. @throws Cancelled
[[nodiscard]] PrimitiveSurface make_surface(const Primitive& primitive, const AlignedBox& region,
                                            const RunContext& run);

}  // namespace cloud2csg
