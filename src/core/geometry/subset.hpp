#pragma once

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {

/// At most `most` entries, evenly along the list: all where there are no more. O(most)
template <std::ranges::random_access_range List>
[[nodiscard]] std::vector<std::ranges::range_value_t<List>> some_of(const List& list, std::size_t most) {
  const std::size_t size = std::ranges::size(list);
  const std::size_t count = size < most ? size : most;
  std::vector<std::ranges::range_value_t<List>> some;
  some.reserve(count);
  for (std::size_t k = 0; k < count; ++k) some.push_back(list[k * size / count]);
  return some;
}

/// The points with these indices, in this order. O(indices)
template <std::ranges::sized_range Indices>
[[nodiscard]] Points select_points(PointsView points, const Indices& indices) {
  Points selected;
  selected.reserve(std::ranges::size(indices));
  for (const std::size_t i : indices) selected.push_back(points[i]);
  return selected;
}

/// The indices where `chosen` equals `says`, ascending.
[[nodiscard]] std::vector<std::uint32_t> places_where(const std::vector<bool>& chosen, bool says = true);

/// The cloud without the points of these indices. O(n)
[[nodiscard]] inline PointCloud without_points(const PointCloud& cloud, const std::vector<std::uint32_t>& left_out) {
  std::vector<bool> is_out(cloud.size(), false);
  for (const std::uint32_t i : left_out) is_out[i] = true;
  return select_points(cloud, places_where(is_out, false));
}

/// A sample of 0 .. count - 1: a random one out of every few, `most` at most, ascending. The choice is random because
/// scans come in rows, and a fixed step may follow a column of them. Precondition: most > 0. O(most)
[[nodiscard]] std::vector<std::uint32_t> one_of_every_few(std::size_t count, std::size_t most, RandomStream random);

inline void append(Points& points, const Points& more) {
  points.x.insert(points.x.end(), more.x.begin(), more.x.end());
  points.y.insert(points.y.end(), more.y.begin(), more.y.end());
  points.z.insert(points.z.end(), more.z.begin(), more.z.end());
}

/// Precondition: both clouds have the same columns, or `cloud` is empty. O(more)
inline void append(PointCloud& cloud, const PointCloud& more) {
  append(cloud.positions, more.positions);
  append(cloud.normals, more.normals);
  append(cloud.sensor_positions, more.sensor_positions);
}

}  // namespace cloud2csg
