#include "cells/sight_lines.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/parallel.hpp"
#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// By point: whether it is near a primitive's surface.
std::vector<char> are_near(const Points& points, const ReachingPrimitives& reaching, double tolerance,
                           const RunContext& run) {
  std::vector<std::vector<std::uint32_t>> near(reaching.primitives.size());
  for_each_index(near.size(), run, [&](std::size_t p) {
    Points reached;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (!reaching.reach[p].contains(points[i])) continue;
      reached.push_back(points[i]);
      near[p].push_back(i);
    }
    const std::vector<double> distances = signed_distance(reaching.primitives[p], reached);
    std::size_t k = 0;
    std::erase_if(near[p], [&](std::uint32_t) { return std::abs(distances[k++]) > tolerance; });
  });
  std::vector<char> is_near(points.size(), 0);
  for (const std::vector<std::uint32_t>& of_primitive : near) {
    for (const std::uint32_t i : of_primitive) is_near[i] = 1;
  }
  return is_near;
}

/// How much of the way from a to b is before the box.
double share_before(const AlignedBox& box, const Vector3d& a, const Vector3d& b) {
  double entry = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = b[axis] - a[axis];
    if (way == 0) continue;
    entry = std::max(entry, ((way > 0 ? box.min() : box.max())[axis] - a[axis]) / way);
  }
  return std::min(entry, 1.0);
}

void add_places(const AlignedBox& box, const Vector3d& sensor, const Vector3d& point, PointCloud& places) {
  const double first = share_before(box, sensor, point);
  for (std::size_t k = 0; k < k_places_a_line; ++k) {
    const double along = first + (1 - first) * (static_cast<double>(k) + 0.5) / k_places_a_line;
    places.positions.push_back(sensor + along * (point - sensor));
    places.normals.push_back(Vector3d::Zero());  // of no surface
  }
}

}  // namespace

SightLines find_sight_lines(const PointCloud& cloud, std::span<const std::uint32_t> order,
                            const ReachingPrimitives& reaching, const CellOptions& options, const RunContext& run) {
  SightLines lines;
  if (!cloud.has_sensor_positions()) return lines;
  std::vector<std::uint32_t> seen = some_of(order, options.sight_lines);
  if (seen.empty()) return lines;
  lines.points_each = static_cast<double>(order.size()) / static_cast<double>(seen.size());
  const Points ends = select_points(cloud.positions, seen);
  const std::vector<char> is_near = are_near(ends, reaching, options.tolerances.distance, run);
  std::size_t k = 0;
  std::erase_if(seen, [&](std::uint32_t) { return is_near[k++] == 0; });
  // Lines from one sensor to neighbours are near each other all along.
  std::ranges::stable_sort(seen, {}, [&](std::uint32_t i) {
    const Vector3d sensor = cloud.sensor_positions[i];
    return std::tuple(sensor.x(), sensor.y(), sensor.z());
  });
  const AlignedBox box = bounds_of(cloud.positions);
  for (const std::uint32_t i : seen) add_places(box, cloud.sensor_positions[i], cloud.positions[i], lines.places);
  lines.count = seen.size();
  return lines;
}

}  // namespace cloud2csg
