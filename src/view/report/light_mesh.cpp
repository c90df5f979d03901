#include "view/report/light_mesh.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "core/fields/point_fit.hpp"
#include "core/geometry/spatial_order.hpp"

namespace cloud2csg {
namespace {

using Corners = std::vector<unsigned int>;

struct SinglePositions {
  std::vector<float> values;  // three per vertex
  [[nodiscard]] std::size_t count() const { return values.size() / 3; }
};
constexpr std::size_t k_stride = 3 * sizeof(float);

SinglePositions single_positions(const TriangleMesh& mesh) {
  // Relative to a corner, since single precision loses small parts far from the origin.
  const AlignedBox box = bounds_of(mesh.vertices);
  SinglePositions positions;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d place = mesh.vertices[i] - box.min();
    for (int axis = 0; axis < 3; ++axis) positions.values.push_back(static_cast<float>(place[axis]));
  }
  return positions;
}

Corners simplified(const Corners& corners, const SinglePositions& positions, std::size_t most_corners, float error) {
  Corners result(corners.size());
  result.resize(meshopt_simplify(result.data(), corners.data(), corners.size(), positions.values.data(),
                                 positions.count(), k_stride, most_corners, error, 0, nullptr));
  return result;
}

/// A mesh in which every vertex belongs to one primitive's patch; borders of patches have duplicate vertices.
struct PatchedMesh {
  TriangleMesh mesh;
  std::vector<PrimitiveIndex> owners;  // by vertex
};

/// Replaces the triangles, and renumbers the vertices they use in order of first use.
PatchedMesh with_corners(const PatchedMesh& fine, Corners corners) {
  const std::size_t vertices = fine.owners.size();
  meshopt_optimizeVertexCache(corners.data(), corners.data(), corners.size(), vertices);
  std::vector<unsigned int> place(vertices);
  const std::size_t used = meshopt_optimizeVertexFetchRemap(place.data(), corners.data(), corners.size(), vertices);
  PatchedMesh light{.mesh = {.vertices = Points(used), .triangles = {}}, .owners = {}};
  light.owners.resize(used);
  for (std::size_t i = 0; i < vertices; ++i) {
    if (place[i] >= used) continue;
    light.mesh.vertices.set(place[i], fine.mesh.vertices[i]);
    light.owners[place[i]] = fine.owners[i];
  }
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    light.mesh.triangles.push_back({place[corners[i]], place[corners[i + 1]], place[corners[i + 2]]});
  }
  return light;
}

/// Simplification keeps the lines between patches.
PatchedMesh simplified(const PatchedMesh& fine, std::size_t most_triangles) {
  constexpr float k_error = 0.0008F;  // share of the size
  constexpr float k_any_error = 1.0F;
  Corners corners;
  for (const auto& triangle : fine.mesh.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  const SinglePositions positions = single_positions(fine.mesh);
  Corners light = simplified(corners, positions, 0, k_error);
  if (light.size() > 3 * most_triangles) light = simplified(corners, positions, 3 * most_triangles, k_any_error);
  return with_corners(fine, std::move(light));
}

/// The primitive of each triangle. Cut surfaces have none: the tree's value there is far from zero.
std::vector<PrimitiveIndex> triangle_owners(const TriangleMesh& mesh, const Model& model, const RunContext& run) {
  constexpr double k_reach = 0.004;  // share of the diagonal: above the error of the mesh
  constexpr double k_tie = 1e-6;
  const double diagonal = bounds_of(mesh.vertices).diagonal().norm();
  PointCloud middles;
  for (const auto& [a, b, c] : mesh.triangles) {
    middles.positions.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  }
  const std::vector<std::uint32_t> order = spatial_order(middles.positions, bounds_of(middles.positions), run);
  PointFit fit =
      measure_points(model, middles, k_reach * diagonal, {.order = order, .with_owners = true, .tie = k_tie}, run);
  for (std::size_t i = 0; i < fit.owners.size(); ++i) {
    if (std::abs(fit.signed_distances[i]) > k_reach * diagonal) fit.owners[i] = k_no_owner;
  }
  return std::move(fit.owners);
}

PatchedMesh patched(const TriangleMesh& mesh, const Model& model, const RunContext& run) {
  const std::vector<PrimitiveIndex> owners = triangle_owners(mesh, model, run);
  PatchedMesh patches;
  std::map<std::pair<std::uint32_t, PrimitiveIndex>, std::uint32_t> known;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[t][k];
      const auto next = static_cast<std::uint32_t>(patches.owners.size());
      const auto [entry, is_new] = known.try_emplace({vertex, owners[t]}, next);
      corners[k] = entry->second;
      if (!is_new) continue;
      patches.mesh.vertices.push_back(mesh.vertices[vertex]);
      patches.owners.push_back(owners[t]);
    }
    patches.mesh.triangles.push_back(corners);
  }
  return patches;
}

}  // namespace

std::vector<std::uint16_t> quantised(PointsView points, const AlignedBox& box) {
  constexpr double k_steps = 65535;
  std::vector<std::uint16_t> steps;
  steps.reserve(3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double size = box.sizes()[axis];
      const double share = size > 0 ? (points[i][axis] - box.min()[axis]) / size : 0.0;
      steps.push_back(static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * k_steps)));
    }
  }
  return steps;
}

LightMesh light_mesh(const Model& model, const AlignedBox& extent, int resolution, std::size_t most_triangles,
                     const RunContext& run) {
  const TriangleMesh fine = mesh_surface(model, extent, {.resolution = resolution}, run);
  LightMesh light;
  if (fine.triangles.empty()) return light;
  const PatchedMesh patches = simplified(patched(fine, model, run), most_triangles);
  light.bounds = bounds_of(patches.mesh.vertices);
  light.positions = quantised(patches.mesh.vertices, light.bounds);
  for (const auto& triangle : patches.mesh.triangles) {
    light.corners.insert(light.corners.end(), triangle.begin(), triangle.end());
    light.owners.push_back(patches.owners[triangle[0]]);
  }
  return light;
}

}  // namespace cloud2csg
