#pragma once

#include <functional>

#include "cloud2csg/primitive.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {

/// A point of a primitive's own surface and the outward normal of that primitive there, in the world.
struct SurfacePoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
};

/// The surface of a primitive, to draw points from, uniformly by area.
struct PrimitiveSurface {
  double area = 0.0;  ///< 0 when no part of it lies in the region
  std::function<SurfacePoint(RandomStream&)> draw = {};
  /// Drawn points are no farther from the surface. 0: they are on it; else they are to be moved onto it, see
  /// move_onto_surface().
  double reach = 0.0;
};

/// Closed forms, of the shape without its displacement; a half-space gives the part of its plane around `region`
/// (finite). No area for expressions.
[[nodiscard]] PrimitiveSurface make_plain_surface(const Primitive& primitive, const AlignedBox& region);

}  // namespace cloud2csg
