#pragma once

#include "shape/sample/primitive_surface.hpp"

namespace cloud2csg {

/// The surface of a primitive of which only the field is known: an expression or a displaced solid.
[[nodiscard]] PrimitiveSurface make_field_surface(const Primitive& primitive, const AlignedBox& region,
                                                  const RunContext& run);

}  // namespace cloud2csg
