#pragma once

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// Bounds of a displaced solid that lies within `start`, by branch and bound over `start` for each of the six sides.
/// Encloses for sure; each side is tight to a two-hundredth of `start`, or looser where the search would take too long.
/// Precondition: the undisplaced distance changes no faster than the point, as with every shape but an Expression.
[[nodiscard]] AlignedBox displaced_bounds(const Primitive& primitive, const AlignedBox& start);

}  // namespace cloud2csg
