#include "shape/compare/surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/parallel.hpp"
#include "core/fields/lipschitz.hpp"
#include "core/geometry/neighbour_tree.hpp"
#include "core/primitive/surface_points.hpp"
#include "shape/sample/ray_caster.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_chunk_points = 1024;
constexpr std::uint64_t k_mesh_stream = 0x636d706d657368;

/// Calls measure(i) for every point on the threads of the run.
template <typename Measure>
std::vector<double> for_each_point(std::size_t count, const RunContext& run, const Measure& measure) {
  std::vector<double> distances(count);
  for_each_index_by_chunks(count, k_chunk_points, run, [&](std::size_t i) { distances[i] = measure(i); });
  return distances;
}

Points sample_mesh(const TriangleMesh& mesh, const CompareOptions& options) {
  const TriangleSampler sampler(mesh.vertices, mesh.triangles);
  if (!(sampler.area() > 0.0)) {
    throw Error({.where = "mesh", .expected = "the mesh is empty: it has no surface"});
  }
  RandomStream random(options.seed, k_mesh_stream);
  Points points(options.surface_samples);
  for (std::size_t i = 0; i < points.size(); ++i) points.set(i, sampler.draw(random).position);
  return points;
}

std::vector<double> distances_to_cloud(const PointCloud& cloud, const Points& points, const RunContext& run) {
  const NeighbourTree tree(cloud.positions);
  return for_each_point(points.size(), run, [&](std::size_t i) { return tree.nearest(points[i]).distance; });
}

constexpr double k_no_foot = -1.0;

/// The distance to the foot of the perpendicular onto the primitive that decides, where that foot is on the surface
/// of the whole solid; else k_no_foot. As no field falls faster than the distance, nothing is nearer then.
std::vector<double> distances_to_feet(const Model& model, const Points& points) {
  const std::vector<double> values = implicit_value(*model.tree, model.primitives, points);
  const Points gradients = implicit_gradient(*model.tree, model.primitives, points);
  constexpr double k_relative_epsilon = 1e-7;
  const double epsilon = k_relative_epsilon * bounds_of(*model.tree, model.primitives).diagonal().norm();
  Points outer(points.size());
  Points inner(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d direction = gradients[i] / gradients[i].norm();
    const Vector3d foot = points[i] - values[i] / gradients[i].norm() * direction;
    outer.set(i, foot + epsilon * direction);
    inner.set(i, foot - epsilon * direction);
  }
  const std::vector<double> outside = implicit_value(*model.tree, model.primitives, outer);
  const std::vector<double> inside = implicit_value(*model.tree, model.primitives, inner);
  std::vector<double> distances(points.size(), k_no_foot);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (outside[i] > 0.0 && inside[i] < 0.0) distances[i] = std::abs(values[i]) / gradients[i].norm();
  }
  return distances;
}

std::vector<double> distances_to_model(const Model& model, const Points& points, const RunContext& run) {
  std::vector<double> distances(points.size());
  for_each_index((points.size() + k_chunk_points - 1) / k_chunk_points, run, [&](std::size_t chunk) {
    const std::size_t first = chunk * k_chunk_points;
    const std::size_t count = std::min(k_chunk_points, points.size() - first);
    Points part(count);
    for (std::size_t i = 0; i < count; ++i) part.set(i, points[first + i]);
    std::ranges::copy(distances_to_feet(model, part), distances.begin() + static_cast<std::ptrdiff_t>(first));
  });
  // Where the field may fall faster, a nearer part of the surface may be hidden: look at the mesh for all points.
  const bool is_exact = lipschitz_bound(*model.tree, model.primitives) == 1;
  if (is_exact && std::ranges::find(distances, k_no_foot) == distances.end()) return distances;
  const TriangleMesh surface =
      mesh_surface(*model.tree, model.primitives, bounds_of(*model.tree, model.primitives), {}, run);
  const RayCaster caster(surface);
  return for_each_point(points.size(), run, [&](std::size_t i) {
    const double foot = distances[i];
    if (foot != k_no_foot && (is_exact || foot == 0.0)) return foot;
    const double mesh = caster.distance(points[i]);
    return foot == k_no_foot ? mesh : std::min(foot, mesh);
  });
}

}  // namespace

Points surface_points(const Shape3d& shape, const CompareOptions& options, const RunContext& run) {
  if (shape.cloud) return shape.cloud->positions;
  if (shape.mesh) return sample_mesh(*shape.mesh, options);
  return sample_surface(*shape.model->tree, shape.model->primitives,
                        {.count = options.surface_samples, .seed = options.seed}, run)
      .positions;
}

std::vector<double> distances_to(const Shape3d& shape, const Points& points, const RunContext& run) {
  if (shape.cloud) return distances_to_cloud(*shape.cloud, points, run);
  if (shape.model) return distances_to_model(*shape.model, points, run);
  const RayCaster caster(*shape.mesh);
  return for_each_point(points.size(), run, [&](std::size_t i) { return caster.distance(points[i]); });
}

}  // namespace cloud2csg
