#pragma once

#include <cstddef>
#include <optional>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {

/// How often something is wrong with a mesh, and where it is for the first time.
struct MeshFault {
  std::size_t count = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
};

struct EdgeFaults {
  MeshFault open;          ///< edges of one triangle only
  MeshFault inconsistent;  ///< edges that two triangles run through in the same direction
};
/// O(triangles log triangles)
[[nodiscard]] EdgeFaults find_edge_faults(const TriangleMesh& mesh);

/// Triangles whose edge goes through another one that they share no vertex with. Touching does not count.
/// O(triangles log triangles) for meshes whose triangles' boxes meet few others.
/// @throws Cancelled
[[nodiscard]] MeshFault find_self_intersections(const TriangleMesh& mesh, const RunContext& run = {});

}  // namespace cloud2csg
