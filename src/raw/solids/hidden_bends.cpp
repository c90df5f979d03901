#include "raw/solids/hidden_bends.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/robust_deviation.hpp"
#include "raw/solids/bores.hpp"
#include "raw/solids/edges.hpp"
#include "raw/solids/wall_cells.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_full_turn = 2 * std::numbers::pi;

/// The piece of a convex torus that has points: angles around its axis.
struct Bend {
  Surface outside;
  Pose pose;  ///< z along the axis
  double first = 0, last = 0;

  [[nodiscard]] double angle_of(const Vector3d& local) const {
    return first + std::fmod(std::atan2(local.y(), local.x()) - first + 2 * k_full_turn, k_full_turn);
  }
  [[nodiscard]] double turn_of(const Vector3d& local) const {
    const double turn = std::atan2(local.z(), local.head<2>().norm() - outside.radius);
    return turn < 0 ? turn + k_full_turn : turn;
  }
  [[nodiscard]] Vector3d place_at(double radius, double angle, double turn) const {
    const double out = outside.radius + radius * std::cos(turn);
    return pose.to_world({out * std::cos(angle), out * std::sin(angle), radius * std::sin(turn)});
  }
};

/// An angle as near to another one as full turns allow.
double near_to(double angle, double other) {
  return other + std::remainder(angle - other, k_full_turn);
}

/// With the ends of the widest gap between its points around the axis, but for a few stray points.
Bend with_ends(Bend bend, const PointCloud& cloud, const std::vector<std::uint32_t>& points) {
  constexpr double k_stray_share = 0.005;  // of the points, at either end
  std::vector<double> angles;
  angles.reserve(points.size());
  for (const std::uint32_t i : points) angles.push_back(bend.angle_of(bend.pose.to_local(cloud.positions[i])));
  std::ranges::sort(angles);
  std::size_t start = 0;
  double widest = angles.front() + k_full_turn - angles.back();
  for (std::size_t k = 1; k < angles.size(); ++k) {
    if (angles[k] - angles[k - 1] <= widest) continue;
    widest = angles[k] - angles[k - 1];
    start = k;
  }
  std::rotate(angles.begin(), angles.begin() + static_cast<std::ptrdiff_t>(start), angles.end());
  const auto stray = static_cast<std::size_t>(k_stray_share * static_cast<double>(angles.size()));
  bend.first = angles[stray];
  bend.last = bend.first + std::fmod(angles[angles.size() - 1 - stray] - bend.first + k_full_turn, k_full_turn);
  return bend;
}

/// The bend ends where straight pieces begin, if there are any.
Bend bend_of(const PointCloud& cloud, const std::vector<DetectedSurface>& surfaces, const DetectedSurface& torus,
             double tolerance) {
  constexpr double k_beyond = 0.2;  // radians: points of the straight pieces may count as the bend's
  Bend bend = with_ends({.outside = torus.surface, .pose = pose_from_axis(torus.surface.position, torus.surface.axis)},
                        cloud, torus.points);
  for (const DetectedSurface& detected : surfaces) {
    const std::optional<Vector3d> place = tangent_place(detected.surface, bend.outside, tolerance);
    if (!place) continue;
    const double angle = bend.angle_of(bend.pose.to_local(*place));
    const double at_first = near_to(angle, bend.first);
    const double at_last = near_to(angle, bend.last);
    const bool is_first = std::abs(at_first - bend.first) < std::abs(at_last - bend.last);
    const double most = std::min(k_beyond, 0.4 * (bend.last - bend.first));
    if (is_first && std::abs(at_first - bend.first) < most) bend.first = at_first;
    if (!is_first && std::abs(at_last - bend.last) < most) bend.last = at_last;
  }
  return bend;
}

/// The place at an end of the bend where a bore goes on as its inside, if it does.
std::optional<Vector3d> way_into(const PointCloud& cloud, const std::vector<DetectedSurface>& surfaces,
                                 const Surface& bore, const Bend& bend, double tolerance) {
  const std::optional<Vector3d> place = tangent_place(bore, bend.outside, tolerance);
  if (!place) return std::nullopt;
  constexpr double k_same = 0.05;  // radians
  const double angle = bend.angle_of(bend.pose.to_local(*place));
  const bool is_at_end = std::abs(near_to(angle, bend.first) - bend.first) < k_same ||
                         std::abs(near_to(angle, bend.last) - bend.last) < k_same;
  return is_at_end && !is_blind(bore, *place, cloud, surfaces) ? place : std::nullopt;
}

/// Median distance of a torus' points from the circle through the middle of the bend, if nearly all agree.
std::optional<double> radius_around(const PointCloud& cloud, const DetectedSurface& torus, const Bend& bend,
                                    double tolerance) {
  Surface circle = bend.outside;
  circle.minor_radius = 0;
  std::vector<double> distances;
  distances.reserve(torus.points.size());
  for (const std::uint32_t i : torus.points) distances.push_back(signed_distance(circle, cloud.positions[i]));
  const double radius = median_of(distances);
  const auto off = std::ranges::count_if(distances, [&](double d) { return std::abs(d - radius) > tolerance; });
  return 10 * off < std::ssize(distances) ? std::optional(radius) : std::nullopt;
}

/// Least distance along the axis from a bore's points to a place on it.
double distance_along(const PointCloud& cloud, const DetectedSurface& bore, const Vector3d& place) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t i : bore.points) {
    least = std::min(least, std::abs((cloud.positions[i] - place).dot(bore.surface.axis)));
  }
  return least;
}

/// The radius that a part of the inside shows, or else the bore that was seen nearest to the bend.
std::optional<double> inner_radius(const PointCloud& cloud, const std::vector<DetectedSurface>& surfaces,
                                   const Bend& bend, double tolerance) {
  std::optional<double> radius;
  double nearest = std::numeric_limits<double>::infinity();
  for (const DetectedSurface& detected : surfaces) {
    const Surface& surface = detected.surface;
    if (!surface.concave || detected.points.empty()) continue;
    std::optional<double> own;
    double distance = 0;
    if (const auto place = way_into(cloud, surfaces, surface, bend, 3 * tolerance)) {
      own = surface.radius;
      distance = distance_along(cloud, detected, *place);
    }
    if (surface.type == SurfaceType::torus) own = radius_around(cloud, detected, bend, tolerance);
    if (!own || *own > bend.outside.minor_radius - tolerance || distance >= nearest) continue;
    radius = own;
    nearest = distance;
  }
  return radius;
}

/// Points of concave surfaces on the inside of the bend, ascending. If few were seen, they may be on several surfaces.
std::vector<std::uint32_t> points_inside(const PointCloud& cloud, const std::vector<DetectedSurface>& surfaces,
                                         const Surface& inside, const Bend& bend, double tolerance) {
  std::vector<std::uint32_t> points;
  for (const DetectedSurface& detected : surfaces) {
    const SurfaceType type = detected.surface.type;
    if (!detected.surface.concave || (type != SurfaceType::cylinder && type != SurfaceType::torus)) continue;
    for (const std::uint32_t i : detected.points) {
      const Vector3d place = cloud.positions[i];
      const bool is_in_bend = bend.angle_of(bend.pose.to_local(place)) <= bend.last;
      if (is_in_bend && std::abs(signed_distance(inside, place)) < tolerance) points.push_back(i);
    }
  }
  std::ranges::sort(points);
  return points;
}

/// Points spread over those cells of the inside that have none, but that are behind points of the outside.
PointCloud spread(const PointCloud& cloud, const Surface& inside, const std::vector<std::uint32_t>& inner_points,
                  const std::vector<std::uint32_t>& outer_points, const Bend& bend, double cell) {
  constexpr double k_least_columns = 8;
  const double sector = bend.last - bend.first;
  const auto rows = static_cast<std::size_t>(std::max(1.0, bend.outside.radius * sector / cell));
  const auto columns = static_cast<std::size_t>(std::max(k_least_columns, k_full_turn * inside.minor_radius / cell));
  constexpr std::size_t k_most_cells = 1'000'000;
  if (rows > k_most_cells / columns) return {};
  const double row_angle = sector / static_cast<double>(rows);
  const double column_turn = k_full_turn / static_cast<double>(columns);
  const auto with_marks = [&](const std::vector<std::uint32_t>& points) {
    WallCells cells(rows, columns);
    for (const std::uint32_t i : points) {
      const Vector3d local = bend.pose.to_local(cloud.positions[i]);
      if (bend.angle_of(local) > bend.last) continue;
      cells.mark((bend.angle_of(local) - bend.first) / row_angle, bend.turn_of(local) / column_turn);
    }
    return cells;
  };
  const WallCells seen = with_marks(inner_points);
  const WallCells backed = with_marks(outer_points);
  const auto place_at = [&](double row, double column) {
    return bend.place_at(inside.minor_radius, bend.first + row * row_angle, column * column_turn);
  };
  PointCloud points;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      if (seen.is_any_around(row, column) || !backed.is_any_around(row, column)) continue;
      add_cell_points(points, inside, static_cast<double>(row) + 0.5, static_cast<double>(column) + 0.5, place_at,
                      [&](const Vector3d&) { return std::min(cell, inside.minor_radius); });
    }
  }
  return points;
}

}  // namespace

std::vector<HiddenBend> find_hidden_bends(const PointCloud& cloud, const std::vector<DetectedSurface>& surfaces,
                                          const Scale& scale, const RunContext& run) {
  std::vector<HiddenBend> bends;
  if (!cloud.has_sensor_positions()) return bends;
  const double tolerance = 3 * scale.noise + 0.5 * scale.spacing;
  for (const DetectedSurface& torus : surfaces) {
    if (torus.surface.type != SurfaceType::torus || torus.surface.concave || torus.points.empty()) continue;
    run.throw_if_stopped();
    const Bend bend = bend_of(cloud, surfaces, torus, 3 * tolerance);
    if (!(bend.last > bend.first)) continue;
    const std::optional<double> radius = inner_radius(cloud, surfaces, bend, tolerance);
    if (!radius) continue;
    DetectedSurface inside = torus;
    inside.surface.minor_radius = *radius;
    inside.surface.concave = true;
    inside.points = points_inside(cloud, surfaces, inside.surface, bend, 2 * tolerance);
    PointCloud hidden = spread(cloud, inside.surface, inside.points, torus.points, bend, 2 * scale.spacing);
    constexpr std::size_t k_least_hidden = 32;  // fewer are chance
    if (hidden.size() >= k_least_hidden) bends.push_back({.inside = std::move(inside), .hidden = std::move(hidden)});
  }
  return bends;
}

}  // namespace cloud2csg
