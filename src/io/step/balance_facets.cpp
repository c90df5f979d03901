#include "io/step/balance_facets.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/fields/bounded_field.hpp"
#include "core/geometry/facet.hpp"

namespace cloud2csg::brep {
namespace {

/// Distances from points to the surface along the gradient, outward positive; 0 if unknown.
std::vector<double> offsets_of_surface(const Model& field, const Points& points) {
  const std::vector<double> values = implicit_value(*field.tree, field.primitives, points);
  const Points gradients = implicit_gradient(*field.tree, field.primitives, points);
  std::vector<double> offsets(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double steepness = gradients[i].norm();
    if (steepness > 0 && std::isfinite(values[i])) offsets[i] = -values[i] / steepness;
  }
  return offsets;
}

Points middles_of(const TriangleMesh& mesh) {
  Points middles;
  middles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    middles.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  }
  return middles;
}

/// A vertex's share in the volume error of its triangles.
struct Share {
  double volume = 0;
  double area = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

}  // namespace

void balance_facets(TriangleMesh& mesh, const Model& model) {
  constexpr int k_rounds = 2;
  const Model field = bounded_field(model);
  for (int round = 0; round < k_rounds; ++round) {
    const std::vector<double> at_middles = offsets_of_surface(field, middles_of(mesh));
    const std::vector<double> at_vertices = offsets_of_surface(field, mesh.vertices);
    std::vector<Share> shares(mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [a, b, c] = mesh.triangles[t];
      const Eigen::Vector3d area = 0.5 * doubled_area(mesh, mesh.triangles[t]);
      // The mean over the triangle, exact for quadratic offsets.
      const double mean = 0.75 * at_middles[t] + (at_vertices[a] + at_vertices[b] + at_vertices[c]) / 12;
      const double longest = std::sqrt(area.norm());
      const double bounded = std::clamp(mean, -0.5 * longest, 0.5 * longest);
      for (const std::uint32_t corner : mesh.triangles[t]) {
        shares[corner].volume += bounded * area.norm();
        shares[corner].area += area.norm();
        shares[corner].normal += area;
      }
    }
    for (std::size_t v = 0; v < shares.size(); ++v) {
      const double length = shares[v].normal.norm();
      if (length <= 0) continue;
      mesh.vertices.set(v, mesh.vertices[v] + (shares[v].volume / shares[v].area / length) * shares[v].normal);
    }
  }
}

}  // namespace cloud2csg::brep
