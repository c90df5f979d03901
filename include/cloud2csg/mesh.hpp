#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Triangles over shared vertices; counter-clockwise seen from outside.
struct TriangleMesh {
  Points vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct MeshingOptions {
  int resolution = 128;
  bool corners_first = true;
};
void option_table(OptionsOf<MeshingOptions>, auto&& field) {
  using O = MeshingOptions;
  field(&O::resolution, "resolution", "Meshes of solids: cells along the longest side of the bounds", from_to(4, 4096));
  field(&O::corners_first, "corners_first",
        "Keep the solid's corners even if a few of the small triangles around them then overlap. False: cut off such "
        "corners by less than a cell, for programs that need triangles without overlap, such as OpenSCAD.",
        k_library);
}

/// The surface of a solid as a closed mesh, by dual contouring of its implicit value with exact gradients, which keeps
/// edges sharp. Every edge has exactly two triangles. Unbounded solids are cut at `bounds`. Empty for an empty solid.
/// O(surface cells x size): it skips space far from the surface and evaluates only the primitives that matter near it.
/// Expressions are evaluated everywhere within their bounds.
/// @throws Error when neither the solid nor `bounds` is finite, or the resolution is not 4 to 4096; Cancelled
[[nodiscard]] TriangleMesh mesh_surface(const Model& model, const AlignedBox& bounds,
                                        const MeshingOptions& options = {}, const RunContext& run = {});

/// Bounds by the tree, maybe infinite: a union has both operands', an intersection their overlap, a difference the
/// first's.
[[nodiscard]] AlignedBox bounds_of(const Model& model);

/// Whether every edge has exactly two triangles, in opposite directions.
[[nodiscard]] bool is_watertight(const TriangleMesh& mesh);
/// Volume enclosed by a closed mesh; positive when the mesh is oriented outward.
[[nodiscard]] double volume_of(const TriangleMesh& mesh);

/// Reads .stl (binary and text) .off .obj .ply .3mf .glb by the file's ending. Cuts polygons into triangles, joins
/// equal vertices and drops triangles that lose a corner by it. .3mf is read in millimetres. O(vertices log vertices)
/// @throws Error for any other content
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& file);
/// Writes .stl (binary) .off .obj .3mf by the file's ending. Never leaves a partial file. @throws Error
void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace cloud2csg
