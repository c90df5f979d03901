#include "view/picture/draw_solid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/fields/point_fit.hpp"
#include "core/geometry/subset.hpp"
#include "shape/sample/ray_caster.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

struct Hit {
  double depth = std::numeric_limits<double>::infinity();
  Vector3d normal = Vector3d::Zero();
  PrimitiveIndex owner = k_no_owner;

  [[nodiscard]] bool is_hit() const { return std::isfinite(depth); }
};

std::vector<Hit> cast_rays(const TriangleMesh& mesh, const View& view, const RunContext& run) {
  std::vector<Hit> hits(view.columns * view.rows);
  if (mesh.triangles.empty()) return hits;
  const RayCaster caster(mesh);
  for_each_index(view.rows, run, [&](std::size_t row) {
    for (std::size_t column = 0; column < view.columns; ++column) {
      const auto hit = caster.first_hit({.origin = view.origin(column, row), .direction = view.forward});
      if (hit) hits[row * view.columns + column] = {.depth = hit->range, .normal = hit->normal};
    }
  });
  return hits;
}

/// Finds the primitive at each hit and its exact normal; normals of the mesh would show triangles.
void find_owners(std::vector<Hit>& hits, const Model& model, const View& view, const RunContext& run) {
  PointCloud places;
  std::vector<std::size_t> sample_of;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].is_hit()) continue;
    places.positions.push_back(view.origin(i % view.columns, i / view.columns) + hits[i].depth * view.forward);
    sample_of.push_back(i);
  }
  if (places.positions.empty()) return;
  const double near = 2 * view.step;
  const PointFit fit = measure_points(model, places, near, {.with_owners = true}, run);
  std::vector<std::vector<std::size_t>> of_primitive(model.primitives.size());
  for (std::size_t k = 0; k < fit.owners.size(); ++k) {
    // A cut through an unbounded solid belongs to no primitive.
    if (fit.owners[k] == k_no_owner || std::abs(fit.signed_distances[k]) > 10 * near) continue;
    of_primitive[fit.owners[k]].push_back(k);
  }
  for_each_index(of_primitive.size(), run, [&](std::size_t p) {
    const Points normals = gradient(model.primitives[p], select_points(places.positions, of_primitive[p]));
    for (std::size_t j = 0; j < normals.size(); ++j) {
      Hit& hit = hits[sample_of[of_primitive[p][j]]];
      hit.owner = static_cast<PrimitiveIndex>(p);
      const Vector3d normal = normals[j].stableNormalized();
      if (normal.allFinite()) hit.normal = normal.dot(view.forward) > 0 ? Vector3d(-normal) : normal;
    }
  });
}

/// Whether a line separates two samples: an outline, depth step beyond the slope, edge, or border between primitives.
bool is_line(const Hit& a, const Hit& b, double step) {
  if (a.is_hit() != b.is_hit()) return true;
  if (!a.is_hit()) return false;
  constexpr double k_steepest = 12;
  constexpr double k_sharp = 0.85;  // cosine of 32 degrees
  return a.owner != b.owner || std::abs(a.depth - b.depth) > k_steepest * step || a.normal.dot(b.normal) < k_sharp;
}

Vector3f shade(const Hit& hit, const View& view) {
  const Vector3f own = linear_colour(hit.owner == k_no_owner ? k_no_primitive_colour : primitive_colour(hit.owner));
  constexpr float k_white = 0.12F;  // softens colours chosen for contrast
  return brightness(hit.normal, view) * ((1 - k_white) * own + Vector3f::Constant(k_white));
}

}  // namespace

using Eigen::Vector3d;

View view_of(const AlignedBox& box, double azimuth_deg, double elevation_deg, std::size_t columns, std::size_t rows) {
  const double azimuth = azimuth_deg * std::numbers::pi / 180;
  const double elevation = elevation_deg * std::numbers::pi / 180;
  View view{};
  view.columns = columns;
  view.rows = rows;
  const Vector3d level(std::cos(azimuth), std::sin(azimuth), 0);
  view.forward = -(std::cos(elevation) * level + std::sin(elevation) * Vector3d::UnitZ());
  view.right = Vector3d(-level.y(), level.x(), 0);
  view.up = view.right.cross(view.forward);
  const double wide = view.right.cwiseAbs().dot(box.sizes());
  const double high = view.up.cwiseAbs().dot(box.sizes());
  const double deep = view.forward.cwiseAbs().dot(box.sizes());
  constexpr double k_margin = 1.08;
  const auto across = static_cast<double>(columns);
  const auto down = static_cast<double>(rows);
  view.step = k_margin * std::max(wide / across, high / down);
  if (!(view.step > 0)) view.step = 1;
  view.corner = box.center() - 0.5 * view.step * ((across - 1) * view.right - (down - 1) * view.up) -
                (0.5 * deep + 0.01 * (wide + high + deep)) * view.forward;
  return view;
}

Vector3f linear_colour(const Colour& colour) {
  const auto linear = [](std::uint8_t value) { return std::pow(static_cast<float>(value) / 255.0F, 2.2F); };
  return {linear(colour.red), linear(colour.green), linear(colour.blue)};
}

float brightness(const Vector3d& normal, const View& view) {
  const Vector3d light = (-view.forward - 0.55 * view.right + 0.75 * view.up).normalized();
  const double lamp = std::max(0.0, normal.dot(light));
  const double sky = 0.5 + 0.5 * normal.dot(view.up);
  return static_cast<float>(0.28 + 0.62 * lamp + 0.16 * sky);
}

Samples draw_solid(const Model& model, const TriangleMesh& mesh, const View& view, const RunContext& run) {
  std::vector<Hit> hits = cast_rays(mesh, view, run);
  find_owners(hits, model, view, run);
  Samples samples(hits.size());
  const Vector3f line(0.02F, 0.025F, 0.04F);
  for_each_index(view.rows, run, [&](std::size_t row) {
    for (std::size_t column = 0; column < view.columns; ++column) {
      const std::size_t i = row * view.columns + column;
      const bool is_line_here = (column > 0 && is_line(hits[i - 1], hits[i], view.step)) ||
                                (row > 0 && is_line(hits[i - view.columns], hits[i], view.step)) ||
                                (column + 1 < view.columns && is_line(hits[i], hits[i + 1], view.step)) ||
                                (row + 1 < view.rows && is_line(hits[i], hits[i + view.columns], view.step));
      if (!hits[i].is_hit()) continue;
      samples[i] = {.depth = static_cast<float>(hits[i].depth), .colour = is_line_here ? line : shade(hits[i], view)};
    }
  });
  return samples;
}

}  // namespace cloud2csg
