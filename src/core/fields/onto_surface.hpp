#pragma once

#include <vector>

#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// Moves points near a primitive's surface onto it, f = 0, by Newton steps along the gradient, and sets their normals
/// to its direction. Returns for each point whether it arrived without moving farther than `reach`; leave out the
/// others. Precondition: the cloud has normals, of any value. O(points) Meshes and scans have their own steps onto the
/// surface of a whole solid: vertices within cells, hits along rays.
[[nodiscard]] std::vector<bool> move_onto_surface(const Primitive& primitive, double reach, PointCloud& cloud);

}  // namespace cloud2csg
