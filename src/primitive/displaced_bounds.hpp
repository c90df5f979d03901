#pragma once

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// Bounds of a displaced solid that lies within `start`, by subdividing `start` and dropping the cells in which the
/// distance cannot be negative. Encloses for sure; tight to about a hundredth of `start`. About a millisecond.
[[nodiscard]] AlignedBox displaced_bounds(const Primitive& primitive, const AlignedBox& start);

}  // namespace cloud2csg
