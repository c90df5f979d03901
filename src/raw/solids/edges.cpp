#include "raw/solids/edges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/boxes.hpp"

namespace cloud2csg {
namespace {

constexpr double k_parallel_sine = 0.009;  // half a degree
constexpr double k_reach_quantile = 0.01;

/// Adds the bounds as first and last edge.
Bins closed(std::vector<double> edges, double low, double high) {
  std::erase_if(edges, [&](double edge) { return edge <= low || edge >= high; });
  edges.push_back(low);
  edges.push_back(high);
  std::ranges::sort(edges);
  return {.edges = std::move(edges)};
}

std::vector<double> plane_offsets(const Eigen::Vector3d& direction, std::span<const DetectedSurface> surfaces) {
  std::vector<std::pair<std::size_t, double>> found;  // by points, so that the larger of two coinciding planes counts
  for (const DetectedSurface& detected : surfaces) {
    const Surface& surface = detected.surface;
    if (surface.type != SurfaceType::plane || !are_parallel(surface.axis, direction)) continue;
    found.emplace_back(detected.points.size(), surface.position.dot(direction));
  }
  std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<double> offsets;
  offsets.reserve(found.size());
  for (const auto& [points, offset] : found) offsets.push_back(offset);
  return offsets;
}

bool are_orthogonal(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::abs(a.dot(b)) < k_parallel_sine;
}

/// The extent of the points along an axis, without a few extreme points.
std::vector<double> reach_of(const DetectedSurface& detected, const Points& positions) {
  std::vector<double> heights;
  heights.reserve(detected.points.size());
  for (const std::uint32_t i : detected.points) {
    heights.push_back((positions[i] - detected.surface.position).dot(detected.surface.axis));
  }
  if (heights.empty()) return {};
  std::ranges::sort(heights);
  const auto few = static_cast<std::size_t>(k_reach_quantile * static_cast<double>(heights.size()));
  return {heights[few], heights[heights.size() - 1 - few]};
}

}  // namespace

void add_distinct(std::vector<double>& edges, const std::vector<double>& values, double tolerance) {
  for (const double value : values) {
    const bool is_new = std::ranges::none_of(edges, [&](double edge) { return std::abs(edge - value) < tolerance; });
    if (is_new) edges.push_back(value);
  }
}

bool are_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.cross(b).norm() < k_parallel_sine;
}

Eigen::Vector3d upright(const Eigen::Vector3d& direction) {
  constexpr double k_level = 1e-9;
  for (const Eigen::Index k : {2, 1, 0}) {
    if (std::abs(direction[k]) > k_level) return direction[k] < 0 ? Eigen::Vector3d(-direction) : direction;
  }
  return direction;
}

Bins edges_along_axis(const DetectedSurface& surface, const Points& positions,
                      std::span<const DetectedSurface> surfaces, const EdgeRules& rules) {
  const Eigen::Vector3d axis = surface.surface.axis;
  const double origin = surface.surface.position.dot(axis);
  std::vector<double> edges;
  for (const double offset : plane_offsets(axis, surfaces)) {
    add_distinct(edges, {offset - origin}, rules.plane_tolerance);
  }
  add_distinct(edges, reach_of(surface, positions), rules.derived_tolerance);
  auto [low, high] = extent_along(rules.bounds, Eigen::Vector3d::Zero(), axis);
  low -= origin;
  high -= origin;
  if (surface.surface.type == SurfaceType::cone) {
    low = std::max(low, 0.0);
    high = std::max(high, low + rules.derived_tolerance);
  }
  return closed(std::move(edges), low, high);
}

Points points_on(std::span<const DetectedSurface> surfaces, const Points& positions) {
  Points points;
  for (const DetectedSurface& detected : surfaces) {
    for (const std::uint32_t i : detected.points) points.push_back(positions[i]);
  }
  return points.empty() ? positions : points;
}

std::vector<DetectedSurface> bend_planes(std::span<const DetectedSurface> surfaces) {
  std::vector<DetectedSurface> planes;
  for (const DetectedSurface& bend : surfaces) {
    if (bend.surface.type != SurfaceType::torus) continue;
    std::vector<Eigen::Vector3d> directions;
    for (const DetectedSurface& other : surfaces) {
      const bool has_direction =
          other.surface.type == SurfaceType::plane || other.surface.type == SurfaceType::cylinder;
      if (!has_direction || !are_orthogonal(other.surface.axis, bend.surface.axis)) continue;
      const auto is_known = [&](const Eigen::Vector3d& one) { return are_parallel(one, other.surface.axis); };
      if (std::ranges::any_of(directions, is_known)) continue;
      directions.push_back(other.surface.axis);
      DetectedSurface plane;
      plane.surface = {.type = SurfaceType::plane, .position = bend.surface.position, .axis = other.surface.axis};
      planes.push_back(plane);
    }
  }
  return planes;
}

}  // namespace cloud2csg
