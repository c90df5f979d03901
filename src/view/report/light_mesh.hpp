#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {

/// A mesh as a page needs it: few triangles, positions as 16-bit steps in its bounds, and to whom each triangle
/// belongs.
struct LightMesh {
  AlignedBox bounds;
  std::vector<std::uint16_t> positions;  ///< three a vertex; 0 and 65535 are the bounds
  std::vector<std::uint32_t> corners;    ///< three a triangle
  std::vector<PrimitiveIndex> owners;    ///< one a triangle: whose surface it is; k_no_owner where it was cut
  [[nodiscard]] std::size_t triangles() const { return corners.size() / 3; }
};

/// The surface of a solid, simplified where it is flat: no farther than about a thousandth of its size from the fine
/// one, or as far as it takes to have no more than `most_triangles`. @throws as mesh_surface()
[[nodiscard]] LightMesh light_mesh(const Model& model, const AlignedBox& extent, int resolution,
                                   std::size_t most_triangles, const RunContext& run);

/// Steps of 1/65535 of the box, three a point.
[[nodiscard]] std::vector<std::uint16_t> quantised(PointsView points, const AlignedBox& box);

}  // namespace cloud2csg
