#include "raw/solids/edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace cloud2csg {
namespace {

constexpr double k_parallel_sine = 0.009;  // half a degree
constexpr std::size_t k_most_frames = 12;
constexpr std::size_t k_most_edges = 64;  // beyond, only planes make edges
constexpr double k_reach_quantile = 0.01;

bool is_revolved_about_axis(SurfaceType type) {
  return type == SurfaceType::cylinder || type == SurfaceType::cone;
}

/// Adds values at least `tolerance` from all present ones.
void add_distinct(std::vector<double>& edges, const std::vector<double>& values, double tolerance) {
  for (const double value : values) {
    const bool is_new = std::ranges::none_of(edges, [&](double edge) { return std::abs(edge - value) < tolerance; });
    if (is_new) edges.push_back(value);
  }
}

/// Adds the bounds as first and last edge.
Bins closed(std::vector<double> edges, double low, double high) {
  std::erase_if(edges, [&](double edge) { return edge <= low || edge >= high; });
  edges.push_back(low);
  edges.push_back(high);
  std::ranges::sort(edges);
  return {.edges = std::move(edges)};
}

std::pair<double, double> extent(const AlignedBox& box, const Eigen::Vector3d& direction) {
  const double middle = box.center().dot(direction);
  const double half = 0.5 * box.sizes().dot(direction.cwiseAbs());
  return {middle - half, middle + half};
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

/// Where a bent pipe becomes straight along the direction: no edge, but the bend ends in a plane through its axis.
std::vector<double> bend_offsets(const Eigen::Vector3d& direction, std::span<const DetectedSurface> surfaces) {
  std::vector<double> offsets;
  for (const DetectedSurface& detected : surfaces) {
    const Surface& surface = detected.surface;
    if (surface.type == SurfaceType::torus && are_orthogonal(surface.axis, direction)) {
      offsets.push_back(surface.position.dot(direction));
    }
  }
  return offsets;
}

/// Middles and both sides of round surfaces across the direction.
std::vector<double> round_offsets(const Eigen::Vector3d& direction, std::span<const DetectedSurface> surfaces) {
  std::vector<double> offsets = bend_offsets(direction, surfaces);
  for (const DetectedSurface& detected : surfaces) {
    const Surface& surface = detected.surface;
    const bool is_across = surface.type == SurfaceType::cylinder && are_orthogonal(surface.axis, direction);
    if (surface.type != SurfaceType::sphere && !is_across) continue;
    const double middle = surface.position.dot(direction);
    for (const double offset : {middle, middle - surface.radius, middle + surface.radius}) offsets.push_back(offset);
  }
  return offsets;
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

/// A direction, up to sign, and the surfaces that have it.
struct Direction {
  Eigen::Vector3d axis;
  double points = 0;
  std::size_t planes = 0;

  /// A box needs two planes across the direction. A single oblique plane is for polytopes.
  [[nodiscard]] bool can_hold() const { return planes >= 2; }
};

/// Directions of planes and axes, sorted by their points.
std::vector<Direction> distinct_directions(std::span<const DetectedSurface> surfaces) {
  std::vector<Direction> directions;
  for (const DetectedSurface& detected : surfaces) {
    const SurfaceType type = detected.surface.type;
    if (type != SurfaceType::plane && !is_revolved_about_axis(type)) continue;
    auto same = std::ranges::find_if(
        directions, [&](const Direction& direction) { return are_parallel(direction.axis, detected.surface.axis); });
    if (same == directions.end()) same = directions.insert(same, {.axis = detected.surface.axis});
    same->points += static_cast<double>(detected.points.size());
    same->planes += type == SurfaceType::plane ? 1 : 0;
  }
  std::ranges::stable_sort(directions, std::greater{}, &Direction::points);
  return directions;
}

/// Permutes and flips the axes for the least rotation from the coordinate axes.
Eigen::Matrix3d turned_least(const Eigen::Matrix3d& axes) {
  Eigen::Matrix3d best = axes;
  std::array<Eigen::Index, 3> order{0, 1, 2};
  do {
    for (const double x : {1.0, -1.0}) {
      for (const double y : {1.0, -1.0}) {
        Eigen::Matrix3d turned;
        turned.col(0) = x * axes.col(order[0]);
        turned.col(1) = y * axes.col(order[1]);
        turned.col(2) = turned.col(0).cross(turned.col(1));
        if (turned.trace() > best.trace() + 1e-9) best = turned;
      }
    }
  } while (std::ranges::next_permutation(order).found);
  return best;
}

Eigen::Matrix3d frame_of(const Eigen::Vector3d& first, const Eigen::Vector3d& about_second) {
  Eigen::Matrix3d axes;
  axes.col(0) = first.normalized();
  axes.col(1) = (about_second - about_second.dot(axes.col(0)) * axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return turned_least(axes);
}

bool has_axis(const Eigen::Matrix3d& frame, const Eigen::Vector3d& direction) {
  return are_parallel(frame.col(0), direction) || are_parallel(frame.col(1), direction) ||
         are_parallel(frame.col(2), direction);
}

}  // namespace

bool are_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.cross(b).norm() < k_parallel_sine;
}

Bins edges_along(const Eigen::Vector3d& direction, std::span<const DetectedSurface> surfaces, const EdgeRules& rules) {
  std::vector<double> edges;
  add_distinct(edges, plane_offsets(direction, surfaces), rules.plane_tolerance);
  if (!edges.empty()) {
    std::vector<double> more = edges;
    add_distinct(more, round_offsets(direction, surfaces), rules.derived_tolerance);
    if (more.size() <= k_most_edges) edges = std::move(more);
  }
  const auto [low, high] = extent(rules.bounds, direction);
  return closed(std::move(edges), low, high);
}

Bins edges_along_axis(const DetectedSurface& surface, const Points& positions,
                      std::span<const DetectedSurface> surfaces, const EdgeRules& rules) {
  const Eigen::Vector3d axis = surface.surface.axis;
  const double origin = surface.surface.position.dot(axis);
  std::vector<double> edges;
  for (const double offset : plane_offsets(axis, surfaces)) {
    add_distinct(edges, {offset - origin}, rules.plane_tolerance);
  }
  for (const double offset : bend_offsets(axis, surfaces)) {
    add_distinct(edges, {offset - origin}, rules.derived_tolerance);
  }
  add_distinct(edges, reach_of(surface, positions), rules.derived_tolerance);
  auto [low, high] = extent(rules.bounds, axis);
  low -= origin;
  high -= origin;
  if (surface.surface.type == SurfaceType::cone) {
    low = std::max(low, 0.0);
    high = std::max(high, low + rules.derived_tolerance);
  }
  return closed(std::move(edges), low, high);
}

std::vector<Eigen::Matrix3d> orthogonal_frames(std::span<const DetectedSurface> surfaces) {
  const std::vector<Direction> directions = distinct_directions(surfaces);
  std::vector<Eigen::Matrix3d> frames;
  const auto add = [&frames](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const bool is_known =
        std::ranges::any_of(frames, [&](const Eigen::Matrix3d& f) { return has_axis(f, a) && has_axis(f, b); });
    if (!is_known && frames.size() < k_most_frames) frames.push_back(frame_of(a, b));
  };
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (std::size_t j = i + 1; j < directions.size(); ++j) {
      const bool can_hold = directions[i].can_hold() && directions[j].can_hold();
      if (can_hold && are_orthogonal(directions[i].axis, directions[j].axis)) {
        add(directions[i].axis, directions[j].axis);
      }
    }
  }
  for (const Direction& direction : directions) {
    const bool is_known =
        std::ranges::any_of(frames, [&](const Eigen::Matrix3d& f) { return has_axis(f, direction.axis); });
    if (is_known || direction.planes == 0 || (!direction.can_hold() && !frames.empty())) continue;
    const auto across = std::ranges::find_if(
        directions, [&](const Direction& other) { return are_orthogonal(other.axis, direction.axis); });
    Eigen::Index least = 0;
    direction.axis.cwiseAbs().minCoeff(&least);
    add(direction.axis, across != directions.end() ? across->axis : Eigen::Vector3d::Unit(least));
  }
  if (frames.empty()) frames.emplace_back(Eigen::Matrix3d::Identity());
  return frames;
}

}  // namespace cloud2csg
