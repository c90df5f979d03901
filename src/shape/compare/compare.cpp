#include "cloud2csg/compare.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/parallel.hpp"
#include "core/fields/lipschitz.hpp"
#include "core/geometry/boxes.hpp"
#include "core/geometry/neighbour_tree.hpp"
#include "core/primitive/surface_points.hpp"
#include "shape/compare/column_grid.hpp"
#include "shape/sample/ray_caster.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_chunk_points = 1024;
constexpr std::uint64_t k_mesh_stream = 0x636d706d657368;

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

/// The distance to the foot of the perpendicular on the deciding primitive, if that foot is on the solid's surface;
/// else k_no_foot. No field falls faster than the distance, so nothing is nearer.
std::vector<double> distances_to_feet(const Model& model, const Points& points) {
  const std::vector<double> values = implicit_value(*model.tree, model.primitives, points);
  const Points gradients = implicit_gradient(*model.tree, model.primitives, points);
  constexpr double k_relative_epsilon = 1e-7;
  const double epsilon = k_relative_epsilon * bounds_of(model).diagonal().norm();
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
  // Where the field may fall faster, a nearer part of the surface may be hidden, so all points use the mesh, too.
  const bool is_exact = lipschitz_bound(*model.tree, model.primitives) == 1;
  if (is_exact && std::ranges::find(distances, k_no_foot) == distances.end()) return distances;
  const TriangleMesh surface = mesh_surface(model, bounds_of(model), {}, run);
  const RayCaster caster(surface);
  return for_each_point(points.size(), run, [&](std::size_t i) {
    const double foot = distances[i];
    if (foot != k_no_foot && (is_exact || foot == 0.0)) return foot;
    const double mesh = caster.distance(points[i]);
    return foot == k_no_foot ? mesh : std::min(foot, mesh);
  });
}

/// Points on a shape's surface: uniform by area, or the cloud itself. Deterministic for a seed. @throws Error for a
/// solid without surface; Cancelled.
Points surface_points(const Shape3d& shape, const CompareOptions& options, const RunContext& run) {
  if (shape.cloud) return shape.cloud->positions;
  if (shape.mesh) return sample_mesh(*shape.mesh, options);
  return sample_surface(*shape.model, {.count = options.surface_samples, .seed = options.seed}, run).positions;
}

/// The distance of each point to a shape's surface. Exact for meshes, and for models if the foot of the perpendicular
/// onto the nearest primitive is on the surface. Otherwise the distance to a mesh of the model (off by about 1e-5 of
/// its size where it is curved). For clouds, the distance to the nearest point.
std::vector<double> distances_to(const Shape3d& shape, const Points& points, const RunContext& run) {
  if (shape.cloud) return distances_to_cloud(*shape.cloud, points, run);
  if (shape.model) return distances_to_model(*shape.model, points, run);
  const RayCaster caster(*shape.mesh);
  return for_each_point(points.size(), run, [&](std::size_t i) { return caster.distance(points[i]); });
}

struct Volumes {
  std::optional<double> truth, result, common;  ///< absent for a shape without volume
};

constexpr std::size_t k_chunk_columns = 1024;

/// Bounds of a shape with a volume; empty for others.
AlignedBox volume_bounds(const Shape3d& shape) {
  if (shape.mesh) return bounds_of(shape.mesh->vertices.view());
  if (!shape.model) return {};
  const AlignedBox box = bounds_of(*shape.model);
  if (!box.isEmpty() && !is_finite(box)) {
    throw Error({.where = "tree",
                 .expected = "the solid is unbounded: it has no volume",
                 .remedy = "intersect it with a bounded primitive such as a box"});
  }
  return box;
}

class SolidColumns {
 public:
  SolidColumns(const Shape3d& shape, const ColumnGrid& grid, const RunContext& run) {
    if (shape.model) model_.emplace(*shape.model, grid);
    if (shape.mesh) mesh_.emplace(*shape.mesh, grid, run);
    // A column may graze an edge and miscount a triangle; a hole leaves many columns open.
    constexpr double k_tolerated_share = 1e-3;
    has_volume_ = model_ || (mesh_ && static_cast<double>(mesh_->open_columns()) <=
                                          k_tolerated_share * static_cast<double>(grid.size()));
  }

  [[nodiscard]] bool has_volume() const { return has_volume_; }
  [[nodiscard]] ColumnCuts cuts(std::size_t first, std::size_t count) const {
    return model_ ? model_->cuts(first, count) : mesh_->cuts(first, count);
  }

 private:
  std::optional<ModelColumns> model_;
  std::optional<MeshColumns> mesh_;
  bool has_volume_ = false;
};

double total_length(std::span<const double> cuts) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < cuts.size(); i += 2) length += cuts[i + 1] - cuts[i];
  return length;
}

double common_length(std::span<const double> a, std::span<const double> b) {
  double length = 0.0;
  for (std::size_t i = 0, j = 0; i + 1 < a.size() && j + 1 < b.size();) {
    const double from = std::max(a[i], b[j]);
    const double to = std::min(a[i + 1], b[j + 1]);
    if (to > from) length += to - from;
    (a[i + 1] < b[j + 1] ? i : j) += 2;
  }
  return length;
}

struct Lengths {
  double truth = 0.0, result = 0.0, common = 0.0;
};

Lengths measure_chunk(const SolidColumns& truth, const SolidColumns& result, std::size_t first, std::size_t count) {
  const ColumnCuts truth_cuts = truth.has_volume() ? truth.cuts(first, count) : ColumnCuts{};
  const ColumnCuts result_cuts = result.has_volume() ? result.cuts(first, count) : ColumnCuts{};
  Lengths lengths;
  for (std::size_t column = 0; column < count; ++column) {
    if (truth.has_volume()) lengths.truth += total_length(truth_cuts.of(column));
    if (result.has_volume()) lengths.result += total_length(result_cuts.of(column));
    if (truth.has_volume() && result.has_volume()) {
      lengths.common += common_length(truth_cuts.of(column), result_cuts.of(column));
    }
  }
  return lengths;
}

/// Volumes by columns over the joint bounds; none for clouds and open meshes. @throws Error if unbounded; Cancelled.
Volumes measure_volumes(const Shape3d& truth, const Shape3d& result, int resolution, const RunContext& run) {
  AlignedBox box = volume_bounds(truth);
  box.extend(volume_bounds(result));
  Volumes volumes;
  if (box.isEmpty() || box.sizes().maxCoeff() <= 0.0) return volumes;
  const ColumnGrid grid(box, resolution);
  const SolidColumns truth_columns(truth, grid, run);
  const SolidColumns result_columns(result, grid, run);

  std::vector<Lengths> chunks((grid.size() + k_chunk_columns - 1) / k_chunk_columns);
  for_each_index(chunks.size(), run, [&](std::size_t i) {
    const std::size_t first = i * k_chunk_columns;
    chunks[i] = measure_chunk(truth_columns, result_columns, first, std::min(k_chunk_columns, grid.size() - first));
  });
  Lengths sum;
  for (const Lengths& chunk : chunks) {
    sum.truth += chunk.truth;
    sum.result += chunk.result;
    sum.common += chunk.common;
  }
  const double area = grid.spacing() * grid.spacing();
  if (truth_columns.has_volume()) volumes.truth = sum.truth * area;
  if (result_columns.has_volume()) volumes.result = sum.result * area;
  if (truth_columns.has_volume() && result_columns.has_volume()) volumes.common = sum.common * area;
  return volumes;
}

void check_shape(const Shape3d& shape, const char* role) {
  const auto fail = [role](const char* expected, const char* remedy) {
    throw Error({.where = role, .expected = expected, .remedy = remedy});
  };
  const int kinds = (shape.model ? 1 : 0) + (shape.mesh ? 1 : 0) + (shape.cloud ? 1 : 0);
  if (kinds != 1) fail("expected one of a model, a mesh and a point cloud", "");
  if (shape.model && !shape.model->tree) fail("the model has no tree, only primitives", "run extract on it first");
  if (shape.cloud && shape.cloud->size() == 0) fail("the point cloud is empty", "");
  if (shape.mesh && shape.mesh->triangles.empty()) fail("the mesh is empty", "");
}

struct OneSided {
  double mean = 0.0;
  double largest = 0.0;
};

OneSided summarise(const std::vector<double>& distances) {
  OneSided sides;
  for (const double distance : distances) {
    sides.mean += distance / static_cast<double>(distances.size());
    sides.largest = std::max(sides.largest, distance);
  }
  return sides;
}

std::optional<double> ratio(std::size_t result, std::size_t truth) {
  if (result == truth) return 1.0;  // also for two single leaves, whose depth is 0
  if (truth == 0) return std::nullopt;
  return static_cast<double>(result) / static_cast<double>(truth);
}

}  // namespace

Comparison compare(const Shape3d& truth, const Shape3d& result, const CompareOptions& options, const RunContext& run) {
  validate(options);
  check_shape(truth, "truth");
  check_shape(result, "result");
  Comparison comparison;
  if (truth.model && result.model) {
    comparison.size_ratio = ratio(result.model->tree->size(), truth.model->tree->size());
    comparison.depth_ratio = ratio(depth(*result.model->tree), depth(*truth.model->tree));
  }
  constexpr std::size_t k_steps = 3;
  run.report("compare", 0, k_steps);
  const Volumes volumes = measure_volumes(truth, result, options.resolution, run);
  comparison.volume_truth = volumes.truth;
  comparison.volume_result = volumes.result;
  if (volumes.common) {
    const double joined = *volumes.truth + *volumes.result - *volumes.common;
    if (joined > 0.0) comparison.intersection_over_union = *volumes.common / joined;
  }
  run.report("compare", 1, k_steps);
  const OneSided forth = summarise(distances_to(result, surface_points(truth, options, run), run));
  run.report("compare", 2, k_steps);
  const OneSided back = summarise(distances_to(truth, surface_points(result, options, run), run));
  run.report("compare", k_steps, k_steps);
  comparison.mean_distance = 0.5 * (forth.mean + back.mean);
  comparison.hausdorff_distance = std::max(forth.largest, back.largest);
  return comparison;
}

}  // namespace cloud2csg
