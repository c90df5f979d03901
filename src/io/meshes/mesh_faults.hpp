#pragma once

#include <cstddef>
#include <optional>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {

/// How often a fault occurs, and the place of its first occurrence.
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

/// Counts triangles with an edge through another triangle, without a shared vertex. Touching does not count.
/// O(triangles log triangles) if the triangles' boxes meet few others. @throws Cancelled
[[nodiscard]] MeshFault find_self_intersections(const TriangleMesh& mesh, const RunContext& run = {});

}  // namespace cloud2csg
