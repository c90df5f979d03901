#include "core/geometry/sensor_views.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/base/robust_deviation.hpp"
#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t k_view_stream = 0x7669'6577;
constexpr double k_near_sensors = 0.05;  ///< share of the cloud's diagonal: sensors as close as this see the same
constexpr std::size_t k_most_views = 256;
constexpr double k_points_a_cell = 3;  ///< minimum of the average over the cells with points
constexpr int k_finest = 512;
constexpr double k_grazing = 0.2;  ///< cosine of incidence below which returns are lost
constexpr std::size_t k_reference_points = 2000;

struct GridCell {
  int row, column;

  [[nodiscard]] std::size_t index(int resolution) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(resolution) + static_cast<std::size_t>(column);
  }
};

GridCell cell_of(const Vector3d& direction, int resolution) {
  const Vector3d p = direction / direction.cwiseAbs().sum();
  double u = p.x();
  double v = p.y();
  if (p.z() < 0) {
    u = (1 - std::abs(p.y())) * (p.x() < 0 ? -1 : 1);
    v = (1 - std::abs(p.x())) * (p.y() < 0 ? -1 : 1);
  }
  const auto step = [resolution](double t) {
    return std::clamp(static_cast<int>((t + 1) / 2 * resolution), 0, resolution - 1);
  };
  return {.row = step(v), .column = step(u)};
}

/// Points grouped by sensor position, the largest groups first.
std::vector<std::vector<std::uint32_t>> by_sensor(const PointCloud& cloud) {
  const double edge = std::max(k_near_sensors * bounds_of(cloud.positions).diagonal().norm(), 1e-300);
  std::map<std::array<double, 3>, std::vector<std::uint32_t>> groups;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Vector3d cell = (cloud.sensor_positions[i] / edge).array().floor();
    groups[{cell.x(), cell.y(), cell.z()}].push_back(i);
  }
  std::vector<std::vector<std::uint32_t>> result;
  result.reserve(groups.size());
  for (auto& [cell, points] : groups) result.push_back(std::move(points));
  std::ranges::stable_sort(result, std::greater<>{}, &std::vector<std::uint32_t>::size);
  if (result.size() > k_most_views) result.resize(k_most_views);
  return result;
}

}  // namespace

SensorViews::View SensorViews::make_view(const PointCloud& cloud, std::span<const std::uint32_t> points) {
  View view;
  view.sensor = Vector3d::Zero();
  for (const std::uint32_t i : points) view.sensor += cloud.sensor_positions[i] / static_cast<double>(points.size());
  std::vector<std::pair<std::size_t, float>> seen(points.size());  // cell, range
  const auto look = [&](int resolution) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vector3d way = cloud.positions[points[k]] - view.sensor;
      seen[k] = {way.isZero() ? 0 : cell_of(way, resolution).index(resolution), static_cast<float>(way.norm())};
    }
    std::ranges::sort(seen);
    std::size_t cells = 1;
    for (std::size_t k = 1; k < seen.size(); ++k) cells += seen[k].first != seen[k - 1].first ? 1 : 0;
    return static_cast<double>(seen.size()) / static_cast<double>(cells);
  };
  view.resolution = k_finest;
  double points_a_cell = look(view.resolution);
  while (points_a_cell < k_points_a_cell && view.resolution > 1) points_a_cell = look(view.resolution /= 2);
  const auto cells = static_cast<std::size_t>(view.resolution) * static_cast<std::size_t>(view.resolution);
  const double steradians = 4 * std::numbers::pi / static_cast<double>(cells);
  view.width = std::sqrt(steradians);
  view.points_a_steradian = points_a_cell / steradians;
  view.first.assign(cells + 1, 0);
  view.ranges.reserve(seen.size());
  for (const auto& [cell, range] : seen) {
    ++view.first[cell + 1];
    view.ranges.push_back(range);
  }
  std::partial_sum(view.first.begin(), view.first.end(), view.first.begin());
  return view;
}

SensorViews::SensorViews(const PointCloud& cloud) {
  for (const std::vector<std::uint32_t>& points : by_sensor(cloud)) views_.push_back(make_view(cloud, points));
}

double SensorViews::density_at(const Vector3d& place, const Vector3d& normal) const {
  return density(place, normal, false);
}

double SensorViews::density_at_bare(const Vector3d& place, const Vector3d& normal) const {
  return density(place, normal, true);
}

double SensorViews::density(const Vector3d& place, const Vector3d& normal, bool is_bare) const {
  double density = 0;
  for (const View& view : views_) {
    const Vector3d way = place - view.sensor;
    const double range = way.norm();
    if (!(range > 0)) continue;
    const double cosine = std::abs(way.dot(normal)) / range;
    if (cosine < k_grazing) continue;
    const double tangent = is_bare ? 0 : std::sqrt(std::max(0.0, 1 - cosine * cosine)) / cosine;
    density += view.points_a_steradian * cosine / (range * range) * share_that_sees(view, way, range, tangent);
  }
  return density;
}

double SensorViews::usual_density(const PointCloud& cloud, std::span<const std::uint32_t> order,
                                  const RunContext& run) const {
  const std::vector<std::uint32_t> points = some_of(order, k_reference_points);
  std::vector<double> densities(points.size());
  for_each_index(points.size(), run, [&](std::size_t k) {
    densities[k] = density_at(cloud.positions[points[k]], cloud.normals[points[k]]);
  });
  return median_of(densities);
}

double SensorViews::share_that_sees(const View& view, const Vector3d& way, double range, double tangent) {
  const GridCell middle = cell_of(way, view.resolution);
  const auto at_least = static_cast<float>(range * (1 - view.width * tangent));
  const auto share_of = [&](int distance) {
    std::size_t all = 0;
    std::size_t nearer = 0;
    for (int row = std::max(middle.row - distance, 0); row <= std::min(middle.row + distance, view.resolution - 1);
         ++row) {
      const int first = std::max(middle.column - distance, 0);
      const int last = std::min(middle.column + distance, view.resolution - 1);
      for (int column = first; column <= last; ++column) {
        const std::size_t cell = GridCell{.row = row, .column = column}.index(view.resolution);
        const auto ranges = std::span(view.ranges).subspan(view.first[cell], view.first[cell + 1] - view.first[cell]);
        all += ranges.size();
        nearer += static_cast<std::size_t>(std::ranges::lower_bound(ranges, at_least) - ranges.begin());
      }
    }
    return all == 0 ? std::nullopt : std::optional(1 - static_cast<double>(nearer) / static_cast<double>(all));
  };
  // A cell may have no returns by chance, but hardly all cells around it.
  const std::optional<double> share = share_of(0);
  return share ? *share : share_of(1).value_or(1);
}

std::vector<bool> are_seen(const PointCloud& points, const PointCloud& cloud, std::span<const std::uint32_t> order,
                           const RunContext& run) {
  std::vector<bool> seen(points.size(), true);
  if (!cloud.has_sensor_positions()) return seen;
  const SensorViews views(cloud);
  const double usual = views.usual_density(cloud, order, run);
  std::vector<double> densities(points.size());
  for_each_index_by_chunks(points.size(), 256, run, [&](std::size_t i) {
    densities[i] = views.density_at(points.positions[i], points.normals[i]);
  });
  RandomStream random(0, k_view_stream);
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = random.uniform() * usual < densities[i];
  return seen;
}

}  // namespace cloud2csg
