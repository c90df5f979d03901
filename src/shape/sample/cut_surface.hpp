#pragma once

#include "core/primitive/surface_points.hpp"

namespace cloud2csg {

/// As make_plain_surface(), for a bounded primitive far larger than `region` (finite): all of its surface that lies in
/// the region, and what is near. If points were drawn from the whole surface, hardly any would lie in the region.
/// O(segments or triangles, times the logarithm of the primitive's size over the region's)
[[nodiscard]] PrimitiveSurface make_cut_surface(const Primitive& primitive, const AlignedBox& region);

}  // namespace cloud2csg
