#include "raw/solids/hidden_bends.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/robust_deviation.hpp"
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

/// Angle at which the axis of a cylinder touches the circle through the middle of the bend, if it does.
std::optional<double> tangent_angle(const Surface& cylinder, const Bend& bend, double tolerance) {
  const std::optional<Vector3d> place = tangent_place(cylinder, bend.outside, tolerance);
  if (!place) return std::nullopt;
  const Vector3d local = bend.pose.to_local(*place);
  return std::atan2(local.y(), local.x());
}

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
    const std::optional<double> angle = tangent_angle(detected.surface, bend, tolerance);
    if (!angle) continue;
    const double at_first = near_to(*angle, bend.first);
    const double at_last = near_to(*angle, bend.last);
    const bool is_first = std::abs(at_first - bend.first) < std::abs(at_last - bend.last);
    const double most = std::min(k_beyond, 0.4 * (bend.last - bend.first));
    if (is_first && std::abs(at_first - bend.first) < most) bend.first = at_first;
    if (!is_first && std::abs(at_last - bend.last) < most) bend.last = at_last;
  }
  return bend;
}

/// Whether a bore goes on as the inside of the bend.
bool leads_into(const PointCloud& cloud, const std::vector<DetectedSurface>& surfaces, const Surface& bore,
                const Bend& bend, double tolerance) {
  const std::optional<double> angle = tangent_angle(bore, bend, tolerance);
  if (!angle) return false;
  constexpr double k_same = 0.05;  // radians
  const bool is_at_end = std::abs(near_to(*angle, bend.first) - bend.first) < k_same ||
                         std::abs(near_to(*angle, bend.last) - bend.last) < k_same;
  return is_at_end && !is_blind(bore, bend.place_at(0, *angle, 0), cloud, surfaces);
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
    if (leads_into(cloud, surfaces, surface, bend, 3 * tolerance)) {
      own = surface.radius;
      distance = distance_along(cloud, detected, *tangent_place(surface, bend.outside, 3 * tolerance));
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
  PointCloud points;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      if (seen.is_any_around(row, column) || !backed.is_any_around(row, column)) continue;
      for (const double along : {0.25, 0.75}) {
        for (const double around : {0.25, 0.75}) {
          const double angle = bend.first + (static_cast<double>(row) + along) * row_angle;
          const double turn = (static_cast<double>(column) + around) * column_turn;
          const Vector3d place = bend.place_at(inside.minor_radius, angle, turn);
          const Vector3d inward = normal(inside, place);
          points.positions.push_back(place);
          points.normals.push_back(inward);
          points.sensor_positions.push_back(place + std::min(cell, inside.minor_radius) * inward);
        }
      }
    }
  }
  return points;
}

}  // namespace

std::optional<Vector3d> tangent_place(const Surface& cylinder, const Surface& torus, double tolerance) {
  constexpr double k_most_cosine = 0.1;  // 6 degrees
  if (cylinder.type != SurfaceType::cylinder || torus.type != SurfaceType::torus) return std::nullopt;
  const Vector3d offset = cylinder.position - torus.position;
  const Vector3d foot = offset - offset.dot(cylinder.axis) * cylinder.axis;
  const double height = foot.dot(torus.axis);
  const double off = std::hypot(height, (foot - height * torus.axis).norm() - torus.radius);
  const bool touches = std::abs(cylinder.axis.dot(torus.axis)) < k_most_cosine && off < tolerance;
  return touches ? std::optional<Vector3d>(torus.position + foot) : std::nullopt;
}

bool is_blind(const Surface& bore, const Vector3d& place, const PointCloud& cloud,
              std::span<const DetectedSurface> surfaces) {
  constexpr std::ptrdiff_t k_least_floor_points = 10;
  const double length = (place - bore.position).dot(bore.axis);
  return std::ranges::any_of(surfaces, [&](const DetectedSurface& floor) {
    const SurfaceType type = floor.surface.type;
    if (type != SurfaceType::plane && type != SurfaceType::cone && type != SurfaceType::sphere) return false;
    const auto within = std::ranges::count_if(floor.points, [&](std::uint32_t i) {
      const Vector3d point = cloud.positions[i];
      const double share = (point - bore.position).dot(bore.axis) / length;
      return share > 0 && share < 1 && signed_distance(bore, point) > 0.1 * bore.radius;
    });
    return within >= k_least_floor_points;
  });
}

std::vector<HiddenBend> find_hidden_bends(const PointCloud& cloud, const std::vector<DetectedSurface>& surfaces,
                                          const Scale& scale) {
  std::vector<HiddenBend> bends;
  if (!cloud.has_sensor_positions()) return bends;
  const double tolerance = 3 * scale.noise + 0.5 * scale.spacing;
  for (const DetectedSurface& torus : surfaces) {
    if (torus.surface.type != SurfaceType::torus || torus.surface.concave || torus.points.empty()) continue;
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
