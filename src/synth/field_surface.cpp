#include "synth/field_surface.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "synth/triangle_sampler.hpp"

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

struct FieldValue {
  double value;
  Vector3d gradient;
};

FieldValue field_at(const Primitive& primitive, const Vector3d& p) {
  const PointsView point{{&p.x(), 1}, {&p.y(), 1}, {&p.z(), 1}};
  FieldValue field{};
  evaluate_field(primitive, point,
                 {.distance = {&field.value, 1},
                  .gradient_x = {&field.gradient.x(), 1},
                  .gradient_y = {&field.gradient.y(), 1},
                  .gradient_z = {&field.gradient.z(), 1}});
  return field;
}

/// Moves a point of the mesh onto f = 0 by Newton steps along the gradient. Absent when there is no surface within
/// `reach`: the mesh is wrong there, or it is the cap where the mesh was cut off.
std::optional<SurfacePoint> project(const Primitive& primitive, const Vector3d& start, double reach) {
  constexpr int k_most_steps = 30;
  Vector3d position = start;
  for (int step = 0; step < k_most_steps; ++step) {
    const FieldValue field = field_at(primitive, position);
    const double slope = field.gradient.squaredNorm();
    if (!(slope > 0.0)) return std::nullopt;
    const Vector3d move = field.value / slope * field.gradient;
    position -= move;
    if (!((position - start).norm() <= reach)) return std::nullopt;
    constexpr double k_converged = 1e-12;
    if (move.norm() <= k_converged * (reach + position.norm())) {
      return SurfacePoint{.position = position, .normal = field.gradient / std::sqrt(slope)};
    }
  }
  return std::nullopt;
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
  const auto draw = [primitive, sampler, reach](RandomStream& random) {
    return project(primitive, sampler->draw(random).position, reach);
  };
  return {.area = sampler->area(), .draw = draw};
}

}  // namespace cloud2csg
