#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/geometry/subset.hpp"
#include "shape/sample/ray_caster.hpp"
#include "shape/sample/scan_views.hpp"
#include "shape/sample/surface_sampler.hpp"

namespace cloud2csg {
namespace {

/// Moves hits along their rays from mesh to exact surface. Hits without a surface nearby become absent.
using SettleHits = std::function<void(std::span<const Ray> rays, std::span<std::optional<RayHit>> hits)>;

using Eigen::Vector3d;

struct Solid {
  const CsgTree* tree;
  const PrimitiveSet* primitives;
  double reach;

  [[nodiscard]] std::vector<double> values(PointsView points) const {
    return implicit_value(*tree, *primitives, points);
  }
  [[nodiscard]] Points gradients(PointsView points) const { return implicit_gradient(*tree, *primitives, points); }
};

/// Relative to the distance from the sensor: a few units in the last place of the coordinates.
constexpr double k_converged = 1e-13;

Vector3d place_at(const Ray& ray, double range) {
  return ray.origin + range * ray.direction;
}

/// Newton steps along the rays. Returns the hits that do not converge, or only where the ray leaves the solid.
std::vector<std::size_t> step_to_surface(const Solid& solid, std::span<const Ray> rays,
                                         std::span<std::optional<RayHit>> hits) {
  constexpr int k_most_steps = 12;
  std::vector<std::size_t> moving, left;
  std::vector<double> ranges(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i]) continue;
    moving.push_back(i);
    ranges[i] = hits[i]->range;
  }
  for (int step = 0; step < k_most_steps && !moving.empty(); ++step) {
    Points places;
    for (const std::size_t i : moving) places.push_back(place_at(rays[i], ranges[i]));
    const std::vector<double> values = solid.values(places);
    const Points gradients = solid.gradients(places);
    std::vector<std::size_t> still_moving;
    for (std::size_t k = 0; k < moving.size(); ++k) {
      const std::size_t i = moving[k];
      const double slope = gradients[k].dot(rays[i].direction);
      const double move = -values[k] / slope;
      const double range = ranges[i] + move;
      if (!(slope < 0.0) || !(std::abs(range - hits[i]->range) <= solid.reach)) {
        left.push_back(i);
        continue;
      }
      ranges[i] = range;
      if (std::abs(move) > k_converged * range) {
        still_moving.push_back(i);
      } else {
        hits[i] = RayHit{.range = range, .normal = gradients[k].normalized()};
      }
    }
    moving = std::move(still_moving);
  }
  left.insert(left.end(), moving.begin(), moving.end());
  return left;
}

/// The first place within reach where the ray enters the solid, by repeated subdivision; absent if it does not.
std::optional<RayHit> search_surface(const Solid& solid, const Ray& ray, double hit_range) {
  constexpr std::size_t k_parts = 32;
  double low = hit_range - solid.reach;
  double width = 2.0 * solid.reach;
  std::array<double, k_parts + 1> ranges{};
  while (width > k_converged * hit_range) {
    Points places;
    for (std::size_t k = 0; k <= k_parts; ++k) {
      ranges[k] = low + width * static_cast<double>(k) / static_cast<double>(k_parts);
      places.push_back(place_at(ray, ranges[k]));
    }
    const std::vector<double> values = solid.values(places);
    const auto inside = std::find_if(values.begin(), values.end(), [](double value) { return value <= 0.0; });
    if (inside == values.begin() || inside == values.end()) return std::nullopt;
    low = ranges[static_cast<std::size_t>(inside - values.begin()) - 1];
    width /= static_cast<double>(k_parts);
  }
  Points place;
  place.push_back(place_at(ray, low));
  const Vector3d gradient = solid.gradients(place)[0];
  const Vector3d normal = gradient.squaredNorm() > 0.0 ? Vector3d(gradient.normalized()) : Vector3d(-ray.direction);
  return RayHit{.range = low, .normal = normal};
}

/// For a mesh within `reach` of the solid. The solid must outlive the function.
SettleHits settle_on_solid(const Model& model, double reach) {
  const Solid solid{.tree = &tree_of(model), .primitives = &model.primitives, .reach = reach};
  return [solid](std::span<const Ray> rays, std::span<std::optional<RayHit>> hits) {
    for (const std::size_t i : step_to_surface(solid, rays, hits)) {
      hits[i] = search_surface(solid, rays[i], hits[i]->range);
    }
  };
}

using Eigen::Vector3d;

constexpr std::uint64_t k_thinning_stream = 0x7363616e'04;
constexpr std::size_t k_block_rays = 4096;

[[noreturn]] void refuse_invisible() {
  throw Error({.expected = "no ray of the scanner hits the part"});
}

class Scanner {
 public:
  Scanner(const TriangleMesh& mesh, SettleHits settle, const ScanOptions& options)
      : caster_(mesh), settle_(std::move(settle)), options_(options), target_(target_of(mesh)) {
    views_ = place_views(target_, options_);
  }

  /// All returns with this step between rays, in radians.
  [[nodiscard]] PointCloud scan(double step, const RunContext& run) const {
    const Raster raster = make_raster(options_, step);
    const std::size_t blocks = (raster.size() + k_block_rays - 1) / k_block_rays;
    PointCloud cloud;
    for (std::size_t view = 0; view < views_.size(); ++view) {
      run.report("scan", view, views_.size(), "views");
      std::vector<PointCloud> parts(blocks);
      for_each_index(blocks, run, [&](std::size_t block) { parts[block] = trace(view, raster, block * k_block_rays); });
      for (const PointCloud& part : parts) append(cloud, part);
    }
    run.report("scan", views_.size(), views_.size(), "views");
    return cloud;
  }

 private:
  static ScanTarget target_of(const TriangleMesh& mesh) {
    const AlignedBox box = bounds_of(mesh.vertices);
    return {.middle = box.center(), .radius = 0.5 * box.diagonal().norm()};
  }

  /// The returns of a block of a view's rays.
  [[nodiscard]] PointCloud trace(std::size_t view, const Raster& raster, std::size_t first) const {
    const std::size_t count = std::min(k_block_rays, raster.size() - first);
    std::vector<Ray> rays(count);
    std::vector<std::optional<RayHit>> hits(count);
    for (std::size_t i = 0; i < count; ++i) {
      rays[i] = ray_of(views_[view], raster, first + i);
      hits[i] = caster_.first_hit(rays[i]);
    }
    if (settle_) settle_(rays, hits);
    PointCloud cloud;
    for (std::size_t i = 0; i < count; ++i) {
      if (hits[i]) add_return(cloud, view, rays[i], *hits[i], raster.step, {options_.seed, view, first + i});
    }
    return cloud;
  }

  /// Adds the measurement of a hit, if any returns, at its registered place.
  void add_return(PointCloud& cloud, std::size_t view, const Ray& ray, const RayHit& hit, double step,
                  const RayChances& chances) const {
    if (chances.loss < loss_probability(options_, ray, hit)) return;
    std::optional<RayHit> side;
    if (chances.mixing < options_.mixed_pixels) side = caster_.first_hit(beam_side(ray, step, chances));
    const double range = measured_range(options_, target_, ray, hit, side, step, chances);
    const Pose& registration = views_[view].misplacement;
    cloud.positions.push_back(registration.to_world(ray.origin + range * ray.direction));
    cloud.sensor_positions.push_back(registration.to_world(ray.origin));
    if (options_.with_normals) cloud.normals.push_back(registration.orientation * hit.normal);
  }

  RayCaster caster_;
  SettleHits settle_;
  const ScanOptions& options_;
  ScanTarget target_;
  std::vector<View> views_;
};

/// A random subset of the requested size, in order (Knuth's algorithm S).
PointCloud thin_out(const PointCloud& cloud, const ScanOptions& options) {
  RandomStream random(options.seed, k_thinning_stream);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const auto wanted = static_cast<double>(options.count - kept.size());
    if (random.uniform() * static_cast<double>(cloud.size() - i) < wanted) kept.push_back(i);
  }
  return select_points(cloud, kept);
}

/// The step between rays at which about `wanted` return, estimated by a coarse scan.
double step_for(double wanted, const Scanner& scanner, const ScanOptions& options, const RunContext& run) {
  constexpr double k_coarse_rays = 50'000;
  constexpr int k_most_scans = 3;
  const Raster one_ray = make_raster(options, std::numbers::pi);
  double step = one_ray.step * std::sqrt(static_cast<double>(options.views) / k_coarse_rays);
  for (int scans = 0; scans < k_most_scans; ++scans) {
    const std::size_t returns = scanner.scan(step, run).size();
    if (returns > 0) return step * std::sqrt(static_cast<double>(returns) / wanted);
    step *= 0.5;  // the visible part may be small
  }
  refuse_invisible();
}

/// A scan with a small surplus of points, thinned to the requested number.
PointCloud scan_count(const Scanner& scanner, const ScanOptions& options, const RunContext& run) {
  constexpr double k_surplus = 1.03;
  constexpr double k_finer = 0.97;
  constexpr int k_most_scans = 100;
  double step = step_for(k_surplus * static_cast<double>(options.count), scanner, options, run);
  for (int scans = 0; scans < k_most_scans; ++scans) {
    const PointCloud cloud = scanner.scan(step, run);
    if (cloud.size() >= options.count) return thin_out(cloud, options);
    step *= k_finer;
  }
  refuse_invisible();
}

PointCloud scan_surface(const TriangleMesh& mesh, const SettleHits& settle, const ScanOptions& options,
                        const RunContext& run) {
  if (mesh.triangles.empty()) refuse_invisible();
  const Scanner scanner(mesh, settle, options);
  if (options.angular_step_deg == 0.0) return scan_count(scanner, options, run);
  PointCloud cloud = scanner.scan(options.angular_step_deg * std::numbers::pi / 180.0, run);
  if (cloud.size() == 0) refuse_invisible();
  return cloud;
}

}  // namespace

std::optional<OptionConflict> conflict_in(const ScanOptions& options) {
  if (options.count > 0 || options.angular_step_deg > 0) return std::nullopt;
  return OptionConflict{"count", "expected at least one point"};
}

ScanOptions without_defects(ScanOptions options) {
  options.noise = options.quantisation = 0.0;
  options.grazing_loss = 0.0;
  options.outliers = options.mixed_pixels = 0.0;
  options.rotation_deg = options.translation = 0.0;
  return options;
}

PointCloud scan_mesh(const TriangleMesh& mesh, const ScanOptions& options, const RunContext& run) {
  validate(options);
  return scan_surface(mesh, {}, options, run);
}

PointCloud scan_model(const Model& model, const ScanOptions& options, const RunContext& run) {
  constexpr double k_reach_cells = 3.0;
  validate(options);
  const AlignedBox bounds = finite_bounds(model);
  const TriangleMesh mesh = mesh_surface(model, bounds, options.meshing, run);
  if (mesh.triangles.empty()) refuse_without_surface();
  const double reach = k_reach_cells * bounds.sizes().maxCoeff() / options.meshing.resolution;
  return scan_surface(mesh, settle_on_solid(model, reach), options, run);
}

}  // namespace cloud2csg
