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

/// The surface of a shape, to draw points from, uniformly by area.
struct PlainSurface {
  double area = 0.0;  ///< 0 when no part of it lies in the region, and for expressions
  std::function<SurfacePoint(RandomStream&)> draw = {};
};

/// Closed forms, of the shape without its displacement; a half-space gives the part of its plane around `region`
/// (finite).
[[nodiscard]] PlainSurface make_plain_surface(const Primitive& primitive, const AlignedBox& region);

}  // namespace cloud2csg
