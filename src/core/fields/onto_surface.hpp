#pragma once

#include <vector>

#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// Moves points that are near the surface of a primitive onto it, f = 0, by Newton steps along the gradient, and makes
/// its direction their normals. Returns for each whether it got there without moving farther than `reach`; others are
/// to be left out. O(points)
///
/// Meshes and scans step to the surface of a whole solid in ways of their own: vertices within their cells, hits along
/// their rays. Precondition: the cloud has normals, of any value.
[[nodiscard]] std::vector<bool> move_onto_surface(const Primitive& primitive, double reach, PointCloud& cloud);

}  // namespace cloud2csg
