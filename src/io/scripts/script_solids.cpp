#include "io/scripts/script_solids.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "cloud2csg/mesh.hpp"
#include "core/base/disjoint_sets.hpp"
#include "io/step/balance_facets.hpp"
#include "io/step/kernel_solids.hpp"

namespace cloud2csg::script {
namespace {

/// The corners, joined by faces into connected pieces.
DisjointSets pieces_of(const brep::Facets& facets) {
  DisjointSets pieces(facets.corners.size());
  for (const auto& face : facets.faces) {
    for (const std::uint32_t corner : face) pieces.join(corner, face.front());
  }
  return pieces;
}

}  // namespace

brep::KernelSolid solid_of(const Primitive& primitive, const AlignedBox& everything, int resolution) {
  if (!brep::has_exact_surfaces(primitive)) {
    return {.shape = facets_of(primitive, everything, resolution), .pose = primitive.pose};
  }
  brep::KernelSolid solid = brep::kernel_solid(primitive, everything, {});
  if (const auto* cone = std::get_if<Cone>(&solid.shape); cone != nullptr && cone->radius_bottom == cone->radius_top) {
    solid.shape = Cylinder{.radius = cone->radius_top, .height = cone->height};
  }
  if (auto* torus = std::get_if<Torus>(&solid.shape)) {
    constexpr double k_pinhole = 1e-4;
    torus->minor_radius = std::min(torus->minor_radius, (1 - k_pinhole) * torus->major_radius);
  }
  return solid;
}

brep::Facets facets_of(Primitive primitive, const AlignedBox& everything, int resolution) {
  const OrientedBox box{.pose = {.position = primitive.pose.to_local(everything.center()),
                                 .orientation = primitive.pose.orientation.conjugate()},
                        .half_size = 0.5 * everything.sizes()};
  primitive.pose = Pose();
  const Model solid{.primitives = {primitive}, .tree = CsgTree::leaf(0)};
  TriangleMesh mesh = mesh_surface(solid, enclosing_box(box), {.resolution = resolution, .corners_first = false});
  brep::balance_facets(mesh, solid);
  return brep::kernel_facets(mesh, {});
}

std::vector<brep::Facets> shells_of(const brep::Facets& facets) {
  DisjointSets pieces = pieces_of(facets);
  std::map<std::size_t, brep::Facets> shells;
  std::vector<std::uint32_t> place(facets.corners.size(), 0);
  for (std::size_t i = 0; i < facets.corners.size(); ++i) {
    std::vector<Eigen::Vector3d>& corners = shells[pieces.root(i)].corners;
    place[i] = static_cast<std::uint32_t>(corners.size());
    corners.push_back(facets.corners[i]);
  }
  for (const auto& face : facets.faces) {
    std::vector<std::uint32_t> moved(face.size());
    std::transform(face.begin(), face.end(), moved.begin(), [&place](std::uint32_t corner) { return place[corner]; });
    shells[pieces.root(face.front())].faces.push_back(std::move(moved));
  }
  std::vector<brep::Facets> sorted;
  for (auto& [corner, shell] : shells) {
    if (!shell.faces.empty()) sorted.push_back(std::move(shell));
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const brep::Facets& a, const brep::Facets& b) {
    return std::abs(volume_of(a)) > std::abs(volume_of(b));
  });
  return sorted;
}

double volume_of(const brep::Facets& facets) {
  double volume = 0;
  for (const auto& face : facets.faces) {
    for (std::size_t i = 2; i < face.size(); ++i) {
      const Eigen::Vector3d& a = facets.corners[face[0]];
      volume += a.dot(facets.corners[face[i - 1]].cross(facets.corners[face[i]])) / 6;
    }
  }
  return volume;
}

}  // namespace cloud2csg::script
