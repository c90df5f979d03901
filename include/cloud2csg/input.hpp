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

/// Input: points from whatever a file holds, a cloud or a triangle mesh, and what is doubtful about it.
namespace cloud2csg {

/// Its fields: see the table.
struct InputOptions {
  std::size_t mesh_points = 100'000;
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<InputOptions>, auto&& field) {
  using O = InputOptions;
  field(&O::mesh_points, "mesh_points",
        "Points to draw from a mesh. Enough that details of a hundredth of the part still have dozens.", at_least(1));
  field(&O::seed, k_inner_seed);
}

struct Input {
  PointCloud cloud;
  /// The mesh that the points were drawn from, mended as mend_mesh() does; absent when the file holds a cloud.
  std::optional<TriangleMesh> mesh = {};
  std::vector<std::string> warnings = {};  ///< sentences for the user
};

/// Reads a point cloud (.pcd .xyz .xyzn .txt .pts, .ply without faces), or draws points with normals from a mesh (.stl
/// .off .obj .3mf .glb, .ply with faces). Invalid points of a cloud are left out and a mesh is mended, with a warning.
/// O(points) or O(triangles log triangles).
/// @throws Error when the file cannot be read, has no valid points or triangles with area, or an option is wrong;
/// Cancelled.
[[nodiscard]] Input read_cloud_or_mesh(const std::filesystem::path& file, const InputOptions& options = {},
                                       const RunContext& run = {});

/// Points uniformly by area over the triangles, with the normals of their triangles. The same seed gives the same
/// points on any number of threads. O(points log triangles)
/// @throws Error when no triangle has area or `mesh_points` is 0; Cancelled.
[[nodiscard]] PointCloud sample_mesh(const TriangleMesh& mesh, const InputOptions& options = {},
                                     const RunContext& run = {});
/// The same with the noise of `options`. @throws Error, besides, for a density or noise of normals: a mesh has neither
[[nodiscard]] PointCloud sample_mesh_surface(const TriangleMesh& mesh, const SampleOptions& options,
                                             const RunContext& run = {});

struct MendedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings = {};  ///< sentences for the user: what was mended, what is doubtful, and where
};

/// A mesh fit to draw points from. Triangles without area and repeated ones go; of two that lie on each other back to
/// back, both go (an inner wall), or the later one where most are such (a surface given from both sides). A mesh that
/// is inside out as a whole is turned. Open, inconsistently oriented and self-intersecting ones are only warned of.
/// O(triangles log triangles)
/// @throws Cancelled
[[nodiscard]] MendedMesh mend_mesh(const TriangleMesh& mesh, const RunContext& run = {});

}  // namespace cloud2csg
