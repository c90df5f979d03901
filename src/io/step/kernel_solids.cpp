#include "io/step/kernel_solids.hpp"

#include <cassert>
#include <cmath>
#include <type_traits>
#include <utility>

#include "core/primitive/polytope.hpp"
#include "core/primitive/profile.hpp"
#include "core/primitive/shape.hpp"

namespace cloud2csg::brep {
namespace {

Eigen::Vector3d to_kernel(const Eigen::Vector3d& point, const WorkFrame& frame) {
  return (point - frame.offset) / frame.scale;
}

Facets facets_of(const Polytope& polytope) {
  PolytopeFaces surface = faces_of(polytope);
  Facets facets{.corners = std::move(surface.corners), .faces = {}};
  for (const std::vector<std::size_t>& face : surface.faces) facets.faces.emplace_back(face.begin(), face.end());
  return facets;
}

KernelSolid block_below(const Pose& pose, const AlignedBox& extent, double scale) {
  const double reach = (extent.center() - pose.position).norm() + 0.5 * extent.diagonal().norm();
  // Rounds to few digits. The extra tenth keeps all sides off the box that cuts the model.
  const double unit = std::pow(10.0, std::floor(std::log10(reach)) - 1.0);
  const double half = std::ceil(1.1 * reach / unit) * unit;
  return {.shape = Box{.size = Eigen::Vector3d::Constant(2 * half / scale)},
          .pose = compose(pose, {.position = {0, 0, -half}})};
}

}  // namespace

bool has_exact_surfaces(const Primitive& primitive) {
  return is_plain(primitive);
}

KernelSolid kernel_solid(const Primitive& primitive, const AlignedBox& extent, const WorkFrame& frame) {
  assert(has_exact_surfaces(primitive));
  KernelSolid solid = std::visit(
      [&](const auto& shape) -> KernelSolid {
        using Type = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Type, HalfSpace>) {
          return block_below(primitive.pose, extent, frame.scale);
        } else if constexpr (std::is_same_v<Type, Polytope>) {
          return {.shape = facets_of(shape), .pose = primitive.pose};
        } else if constexpr (std::is_same_v<Type, Extrusion>) {
          return {.shape = SweptProfile{regions_of(shape.profile), shape.height}, .pose = primitive.pose};
        } else if constexpr (std::is_same_v<Type, Revolution>) {
          return {.shape = SweptProfile{regions_of(shape.profile), {}, shape.angle_deg}, .pose = primitive.pose};
        } else if constexpr (std::is_same_v<Type, Expression>) {
          return {.shape = Facets(), .pose = primitive.pose};
        } else {
          return {.shape = shape, .pose = primitive.pose};
        }
      },
      scaled(primitive.shape, 1 / frame.scale));
  solid.pose.position = to_kernel(solid.pose.position, frame);
  return solid;
}

Facets kernel_facets(const TriangleMesh& mesh, const WorkFrame& frame) {
  Facets facets;
  facets.corners.reserve(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) facets.corners.push_back(to_kernel(mesh.vertices[i], frame));
  facets.faces.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) facets.faces.push_back({a, b, c});
  return facets;
}

WorkFrame work_frame(const AlignedBox& extent) {
  constexpr double k_least = 0.5;
  constexpr double k_most = 2e4;
  const double size = extent.sizes().maxCoeff();
  WorkFrame frame;
  // Scaling by powers of two keeps all digits.
  if (size < k_least || size > k_most) frame.scale = std::exp2(std::round(std::log2(size / 100)));
  // Far from the origin, coordinates are too coarse for the kernel's tolerance.
  if (extent.center().norm() > 100 * size) frame.offset = extent.center();
  return frame;
}

AlignedBox to_kernel(const AlignedBox& box, const WorkFrame& frame) {
  return {to_kernel(box.min(), frame), to_kernel(box.max(), frame)};
}

}  // namespace cloud2csg::brep
