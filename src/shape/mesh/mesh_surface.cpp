#include <utility>

#include "cloud2csg/mesh.hpp"
#include "shape/mesh/contour.hpp"
#include "shape/mesh/untangle.hpp"

namespace cloud2csg {
TriangleMesh mesh_surface(const Model& model, const AlignedBox& bounds, const MeshingOptions& options,
                          const RunContext& run) {
  constexpr std::size_t k_steps = 4;
  validate(options);
  const BoundedSolid solid = bound_solid(model, bounds);
  if (solid.bounds.isEmpty()) return {};
  run.report("mesh", 0, k_steps);
  const SparseField field(solid, options.resolution, run);
  const SurfaceCells cells(field, solid);
  run.report("mesh", 1, k_steps);
  const Contour contour = trace_contour(field, cells, solid.primitives, run);
  run.report("mesh", 2, k_steps);
  Placement placement = place_vertices(field, cells, solid.primitives, contour, run);
  run.report("mesh", 3, k_steps);
  TriangleMesh mesh;
  Untangled cut = cut_untangled(field, solid.primitives, contour, std::move(placement), options.corners_first, run);
  mesh.triangles = std::move(cut.triangles);
  mesh.vertices.reserve(cut.positions.size());
  for (const Eigen::Vector3d& position : cut.positions) mesh.vertices.push_back(field.grid().to_world(position));
  run.report("mesh", k_steps, k_steps);
  return mesh;
}

}  // namespace cloud2csg
