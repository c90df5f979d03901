#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {

/// A compact mesh for the page: few triangles, with positions as 16-bit steps in its bounds.
struct LightMesh {
  AlignedBox bounds;
  std::vector<std::uint16_t> positions;  ///< three per vertex; 0 and 65535 are the bounds
  std::vector<std::uint32_t> corners;    ///< three per triangle
  std::vector<PrimitiveIndex> owners;    ///< one per triangle: the primitive of its surface; k_no_owner on a cut
  [[nodiscard]] std::size_t triangles() const { return corners.size() / 3; }
};

/// The surface, simplified within a thousandth of its size, or more for `most_triangles`. @throws as mesh_surface()
[[nodiscard]] LightMesh light_mesh(const Model& model, const AlignedBox& extent, int resolution,
                                   std::size_t most_triangles, const RunContext& run);

/// Steps of 1/65535 of the box, three per point.
[[nodiscard]] std::vector<std::uint16_t> quantised(PointsView points, const AlignedBox& box);

}  // namespace cloud2csg
