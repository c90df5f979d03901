#pragma once

#include <functional>
#include <vector>

#include "cloud2csg/mesh.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "core/primitive/plain_surface.hpp"

namespace cloud2csg {

/// The surface of one primitive, to draw points from, uniformly by area.
struct PrimitiveSurface {
  double area = 0.0;  ///< 0 when no part of it lies in the region
  std::function<SurfacePoint(RandomStream&)> draw = {};
  /// Where drawn points are only near the surface: moves them onto it, in place, normals too. Returns for each
  /// whether it got there; the others are to be left out. Absent where draw() is exact.
  std::function<std::vector<bool>(PointCloud&)> settle = {};
};

/// Closed forms for every plain shape; a half-space gives the part of its plane around `region` (finite). Expressions
/// and displaced solids are meshed finely, drawn by the mesh's area and moved onto f = 0 along the gradient: uniform
/// as far as the mesh has the area of the surface.
/// @throws Cancelled
[[nodiscard]] PrimitiveSurface make_surface(const Primitive& primitive, const AlignedBox& region,
                                            const RunContext& run);

}  // namespace cloud2csg
