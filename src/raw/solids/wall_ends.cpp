#include "raw/solids/wall_ends.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/random.hpp"
#include "core/geometry/neighbour_tree.hpp"
#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::uint64_t k_end_stage = 0x656e'6473;
constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();
constexpr double k_upright = 0.5;    ///< greatest cosine between the normal of a wall and the direction up
constexpr double k_along = 0.985;    ///< least cosine between the axis of a round wall and that direction
constexpr double k_same_wall = 0.7;  ///< least cosine between normals
/// Of a scanner that moves, or all of one with as many stands. With half, an end needs a larger part of the way of the
/// scanner in view; double takes longer.
constexpr std::size_t k_most_sensors = 64;
constexpr std::size_t k_least_sensors = 2;  ///< one position may be wrong
constexpr double k_least_view = 0.2;        ///< least cosine between a wall's normal and the direction to a sensor
constexpr double k_below = 2;               ///< steps below the end of a wall and in front of it

std::vector<bool> are_on_walls(const PointCloud& cloud, std::span<const DetectedSurface> surfaces, const Vector3d& up) {
  std::vector<bool> result(cloud.size(), false);
  for (const DetectedSurface& found : surfaces) {
    const double cosine = std::abs(found.surface.axis.dot(up));
    const bool is_wall = found.surface.type == SurfaceType::plane
                             ? cosine < k_upright
                             : found.surface.type == SurfaceType::cylinder && cosine > k_along;
    for (const std::uint32_t i : found.points) result[i] = is_wall;
  }
  return result;
}

/// By bin: the lowest point that does not face up, or none.
std::vector<std::uint32_t> lowest_points(const PointCloud& cloud, const FloorBins& bins, const Vector3d& up) {
  std::vector<std::uint32_t> lowest(bins.count(), k_none);
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (cloud.normals[i].dot(up) >= k_upright) continue;
    std::uint32_t& own = lowest[bins.number_of(bins.points()[i])];
    if (own == k_none || bins.points().z[i] < bins.points().z[own]) own = i;
  }
  return lowest;
}

std::vector<double> highest_points(const FloorBins& bins) {
  std::vector<double> highest(bins.count(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < bins.points().size(); ++i) {
    double& own = highest[bins.number_of(bins.points()[i])];
    own = std::max(own, bins.points().z[i]);
  }
  return highest;
}

/// Different positions, in the frame.
std::vector<Vector3d> some_sensors(const PointCloud& cloud, const FloorBins& bins) {
  constexpr std::size_t k_asked = 4096;  // points, which know all stands of a scanner
  std::set<std::array<double, 3>> positions;
  for (const std::uint32_t i : one_of_every_few(cloud.size(), k_asked, RandomStream(0, k_end_stage, 0))) {
    const Vector3d sensor = bins.pose().to_local(cloud.sensor_positions[i]);
    positions.insert({sensor.x(), sensor.y(), sensor.z()});
  }
  std::vector<Vector3d> sensors;
  const std::size_t pace = (positions.size() + k_most_sensors - 1) / k_most_sensors;
  std::size_t number = 0;
  for (const auto& [x, y, z] : positions) {
    if (number++ % pace == 0) sensors.emplace_back(x, y, z);
  }
  return sensors;
}

/// Whether sensors see the place just below the end of a wall, even if all is solid below what the part shows. Then
/// they would have seen the wall go on.
bool is_in_view(const WallEnd& end, const FloorBins& bins, const std::vector<Vector3d>& sensors,
                const std::vector<double>& highest) {
  const double step = bins.step();
  const Vector3d place = end.place + k_below * step * Vector3d(end.outward.x(), end.outward.y(), -1);
  const auto sees = [&](const Vector3d& sensor) {
    const Vector3d way = sensor - place;
    if (!(way.head<2>().dot(end.outward) > k_least_view * way.norm())) return false;
    const double far = way.head<2>().norm();
    for (double along = 0; along < far; along += step) {
      const Vector3d at = place + along / far * way;
      if (at.z() >= bins.top() || !bins.is_over(at)) break;
      if (at.z() <= highest[bins.number_of(at)]) return false;
    }
    return true;
  };
  return std::ranges::count_if(sensors, sees) >= static_cast<std::ptrdiff_t>(k_least_sensors);
}

}  // namespace

std::vector<WallEnd> wall_ends(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                               const FloorBins& bins, double foot) {
  const Vector3d up = bins.pose().orientation * Vector3d::UnitZ();
  const std::vector<bool> is_on_wall = are_on_walls(cloud, surfaces, up);
  const std::vector<std::uint32_t> lowest = lowest_points(cloud, bins, up);
  std::vector<WallEnd> ends;
  for (std::size_t bin = 0; bin < bins.count(); ++bin) {
    const std::uint32_t i = lowest[bin];
    if (i == k_none || !is_on_wall[i]) continue;
    const Vector3d normal = bins.pose().orientation.conjugate() * cloud.normals[i];
    WallEnd end{.place = bins.points()[i], .outward = normal.head<2>().normalized()};
    // A single bin often has no point near the end.
    bins.for_each_around(bin, [&](std::size_t other) {
      const std::uint32_t j = lowest[other];
      if (j == k_none || cloud.normals[i].dot(cloud.normals[j]) < k_same_wall) return;
      end.place.z() = std::min(end.place.z(), bins.points().z[j]);
    });
    ends.push_back(end);
  }
  const std::vector<Vector3d> sensors = some_sensors(cloud, bins);
  const std::vector<double> highest = highest_points(bins);
  std::erase_if(ends,
                [&](const WallEnd& end) { return end.place.z() > foot && !is_in_view(end, bins, sensors, highest); });
  return ends;
}

std::optional<double> common_end(std::vector<double> heights, double step) {
  constexpr std::size_t k_least = 12;  // fewer agree by chance
  if (heights.size() < k_least) return std::nullopt;
  std::ranges::sort(heights);
  std::size_t first_of_most = 0;
  std::size_t most = 0;
  for (std::size_t first = 0, last = 0; first < heights.size(); ++first) {
    while (last < heights.size() && heights[last] <= heights[first] + 2 * step) ++last;
    if (last - first <= most) continue;
    most = last - first;
    first_of_most = first;
  }
  if (2 * most <= heights.size()) return std::nullopt;
  // The quartile: noise is below it, and most lowest points are above the end of their wall.
  return heights[first_of_most + most / 4];
}

std::vector<std::uint32_t> bins_behind(const std::vector<WallEnd>& ends, const FloorBins& bins, double foot,
                                       const std::vector<std::uint32_t>& candidates) {
  constexpr std::size_t k_around = 32;  // with half, the outer sides of walls in front of a bin may be all
  Points places;
  for (const WallEnd& end : ends) places.push_back({end.place.x(), end.place.y(), 0});
  if (places.size() == 0) return {};
  const NeighbourTree tree(places);
  std::array<std::uint32_t, k_around> near{};
  std::array<double, k_around> squares{};
  std::vector<std::uint32_t> behind;
  for (const std::uint32_t bin : candidates) {
    const Vector2d middle = bins.place_in(bin, 0.5, 0.5);
    const std::size_t found = tree.find({middle.x(), middle.y(), 0}, near, squares);
    const std::span<const std::uint32_t> nearest = std::span(near).first(found);
    const auto first = std::ranges::find_if(
        nearest, [&](std::uint32_t k) { return (middle - ends[k].place.head<2>()).dot(ends[k].outward) <= 0; });
    if (first != nearest.end() && ends[*first].place.z() > foot) behind.push_back(bin);
  }
  return behind;
}

}  // namespace cloud2csg
