#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/mesh.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/sample.hpp"

/// Reads points from a file with a cloud or a triangle mesh, and warns about doubtful input.
namespace cloud2csg {

struct InputOptions {
  std::size_t mesh_points = 100'000;
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<InputOptions>, auto&& field) {
  using O = InputOptions;
  field(&O::mesh_points, "mesh_points",
        "Points to draw from a mesh. With the default, details of a hundredth of the part still have dozens of points. "
        "If the mesh was made from a scan, all vertices are taken.",
        at_least(1));
  field(&O::seed, k_inner_seed);
}

struct Input {
  PointCloud cloud;
  /// The mesh that the points come from, after mend_mesh(); absent when the file holds a cloud.
  std::optional<TriangleMesh> mesh = {};
  bool is_exact = false;                   ///< the points were drawn from a mesh without noise: they are on its surface
  std::vector<std::string> warnings = {};  ///< sentences for the user
};

/// Reads a point cloud (.pcd .xyz .xyzn .txt .pts, .ply without faces), or draws points with normals from a mesh (.stl
/// .off .obj .3mf .glb, .ply with faces). Takes the vertices of a mesh that was made from a scan: one with vertices
/// everywhere, whose noise tilts the facets. Warns of invalid points, of repairs and of scans. O(points) or O(triangles
/// log triangles).
/// @throws Error when the file cannot be read or has no valid points or triangles, or for a bad option; Cancelled.
[[nodiscard]] Input read_cloud_or_mesh(const std::filesystem::path& file, const InputOptions& options = {},
                                       const RunContext& run = {});

/// Draws points and normals from the triangles, uniformly by area. Does not depend on threads. O(points log triangles)
/// @throws Error when no triangle has area or `mesh_points` is 0; Cancelled.
[[nodiscard]] PointCloud sample_mesh(const TriangleMesh& mesh, const InputOptions& options = {},
                                     const RunContext& run = {});
/// The same with the noise of `options`. @throws Error also for a density or normal noise, which meshes do not support
[[nodiscard]] PointCloud sample_mesh_surface(const TriangleMesh& mesh, const SampleOptions& options,
                                             const RunContext& run = {});

struct MendedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings = {};  ///< sentences for the user: repairs and remaining doubts, with places
};

/// Makes a mesh fit to draw points from. Removes triangles without area and repeated triangles. Of two back-to-back
/// triangles it removes both (an inner wall), or the later one where most triangles are such (a surface given from both
/// sides). Turns triangles that disagree with most of their piece, and inside-out meshes and closed pieces other than
/// cavities. Only warns of open, non-orientable and self-intersecting meshes. O(triangles log triangles)
/// @throws Cancelled
[[nodiscard]] MendedMesh mend_mesh(const TriangleMesh& mesh, const RunContext& run = {});

}  // namespace cloud2csg
