#include "shape/sample/primitive_surface.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "cloud2csg/mesh.hpp"
#include "core/geometry/boxes.hpp"
#include "core/primitive/surface_points.hpp"
#include "shape/sample/cut_surface.hpp"

namespace cloud2csg {
namespace {

/// Cells along the longest side, for the shape and for the waves of a displacement.
int mesh_resolution(const Primitive& primitive, const AlignedBox& bounds) {
  constexpr double k_plain = 160;
  constexpr double k_cells_per_wave = 20;
  constexpr double k_most = 400;  // memory grows with the cube
  if (!primitive.displacement) return static_cast<int>(k_plain);
  const double waves =
      bounds.sizes().maxCoeff() * std::abs(primitive.displacement->frequency) / (2.0 * std::numbers::pi);
  return static_cast<int>(std::clamp(k_cells_per_wave * waves, k_plain, k_most));
}

/// Whether hardly a point drawn from the whole surface would lie in the region.
bool is_far_larger(const Primitive& primitive, const AlignedBox& region) {
  constexpr double k_much = 8;  // then one point in 64 of a face lies in the region; with 4, one in 16
  const AlignedBox box = bounds(primitive);
  return is_finite(box) && box.diagonal().stableNorm() > k_much * region.diagonal().stableNorm();
}

}  // namespace

PrimitiveSurface make_surface(const Primitive& primitive, const AlignedBox& region, const RunContext& run) {
  if (is_plain(primitive)) {
    return is_far_larger(primitive, region) ? make_cut_surface(primitive, region)
                                            : make_plain_surface(primitive, region);
  }
  // Room around the region keeps the cap of a cut solid outside.
  constexpr double k_room = 0.05;
  const double room = k_room * region.diagonal().norm();
  const AlignedBox limits = grown(bounds(primitive), room).intersection(grown(region, room));
  if (limits.isEmpty()) return {};
  const int resolution = mesh_resolution(primitive, limits);
  const TriangleMesh mesh =
      mesh_surface({.primitives = {primitive}, .tree = CsgTree::leaf(0)}, limits, {.resolution = resolution}, run);
  const auto sampler = std::make_shared<const TriangleSampler>(mesh.vertices, mesh.triangles);
  const auto draw = [sampler](RandomStream& random) {
    const TriangleSampler::Draw drawn = sampler->draw(random);
    return SurfacePoint{.position = drawn.position, .normal = sampler->normal(drawn.triangle)};
  };
  // Beyond the reach there is no surface: the mesh is wrong, or it is the cap of the cut.
  return {.area = sampler->area(), .draw = draw, .reach = 2.0 * limits.sizes().maxCoeff() / resolution};
}

}  // namespace cloud2csg
