#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {

/// Twice the area of the triangle with these vertices of the mesh, along its normal. Counter-clockwise from outside.
[[nodiscard]] inline Eigen::Vector3d doubled_area(const TriangleMesh& mesh,
                                                  const std::array<std::uint32_t, 3>& corners) {
  const Eigen::Vector3d a = mesh.vertices[corners[0]];
  return (mesh.vertices[corners[1]] - a).cross(mesh.vertices[corners[2]] - a);
}

}  // namespace cloud2csg
