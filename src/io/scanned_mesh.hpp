#pragma once

#include <cstdint>
#include <optional>

#include "cloud2csg/mesh.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

struct ScannedPoints {
  /// The vertices of facets, and points drawn from facets that are larger than most; without normals, since the facets'
  /// are worse than those estimated from the vertices.
  PointCloud cloud;
  double noise = 0;  ///< standard deviation of the vertices along the normal
};

/// The measured points of a mesh that was made from a scan; absent for other meshes. A scan has vertices everywhere,
/// and their noise tilts the facets. Points drawn from such facets have wrong normals, and follow the noise instead of
/// showing it. The vertices of a mesh from a CAD program lie on the surface, or only on the edges of its faces. `seed`
/// is that of the drawn points. O(triangles + vertices log vertices) @throws Cancelled
[[nodiscard]] std::optional<ScannedPoints> scanned_points(const TriangleMesh& mesh, std::uint64_t seed = 1,
                                                          const RunContext& run = {});

}  // namespace cloud2csg
