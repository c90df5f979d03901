#include "shape/sample/field_surface.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "core/primitive/sampled_field.hpp"
#include "core/primitive/triangle_sampler.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// Cells along the longest side: enough for the shape, and for the waves of a displacement.
int mesh_resolution(const Primitive& primitive, const AlignedBox& bounds) {
  constexpr double k_plain = 160;
  constexpr double k_cells_per_wave = 20;
  constexpr double k_most = 400;  // memory grows with the cube
  if (!primitive.displacement) return static_cast<int>(k_plain);
  const double waves =
      bounds.sizes().maxCoeff() * std::abs(primitive.displacement->frequency) / (2.0 * std::numbers::pi);
  return static_cast<int>(std::clamp(k_cells_per_wave * waves, k_plain, k_most));
}

std::vector<Triangle> triangles_of(const TriangleMesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  }
  return triangles;
}

/// Moves points of the mesh onto f = 0 by Newton steps along the gradient. False where there is no surface within
/// `reach`: the mesh is wrong there, or it is the cap where the mesh was cut off.
std::vector<bool> project(const Primitive& primitive, double reach, PointCloud& cloud) {
  constexpr int k_most_steps = 30;
  constexpr double k_converged = 1e-12;
  const Points start = cloud.positions;
  std::vector<bool> arrived(cloud.size(), false);
  std::vector<std::size_t> moving(cloud.size());
  std::iota(moving.begin(), moving.end(), std::size_t{0});
  for (int step = 0; step < k_most_steps && !moving.empty(); ++step) {
    Points places;
    for (const std::size_t i : moving) places.push_back(cloud.positions[i]);
    const SampledField field = sample_field(primitive, places);
    std::vector<std::size_t> still_moving;
    for (std::size_t k = 0; k < moving.size(); ++k) {
      const std::size_t i = moving[k];
      const Vector3d slope = field.slopes[k];
      const double square = slope.squaredNorm();
      if (!(square > 0.0)) continue;
      const Vector3d move = field.offset(k);
      const Vector3d position = places[k] - move;
      if (!((position - start[i]).norm() <= reach)) continue;
      cloud.positions.set(i, position);
      cloud.normals.set(i, slope / std::sqrt(square));
      arrived[i] = move.norm() <= k_converged * (reach + position.norm());
      if (!arrived[i]) still_moving.push_back(i);
    }
    moving = std::move(still_moving);
  }
  return arrived;
}

}  // namespace

PrimitiveSurface make_field_surface(const Primitive& primitive, const AlignedBox& region, const RunContext& run) {
  AlignedBox limits = bounds(primitive);
  // Room around the region, so that the cap of a solid that is cut off there lies outside.
  constexpr double k_room = 0.05;
  const Vector3d room = Vector3d::Constant(k_room * region.diagonal().norm());
  limits = AlignedBox(limits.min() - room, limits.max() + room)
               .intersection(AlignedBox(region.min() - room, region.max() + room));
  if (limits.isEmpty()) return {};
  const int resolution = mesh_resolution(primitive, limits);
  const TriangleMesh mesh = mesh_surface(CsgTree::leaf(0), {primitive}, limits, {.resolution = resolution}, run);
  const auto sampler = std::make_shared<const TriangleSampler>(triangles_of(mesh));
  const double reach = 2.0 * limits.sizes().maxCoeff() / resolution;
  const auto draw = [sampler](RandomStream& random) {
    const TriangleSampler::Draw drawn = sampler->draw(random);
    return SurfacePoint{.position = drawn.position, .normal = sampler->normal(drawn.triangle)};
  };
  const auto settle = [primitive, reach](PointCloud& cloud) { return project(primitive, reach, cloud); };
  return {.area = sampler->area(), .draw = draw, .settle = settle};
}

}  // namespace cloud2csg
