#include "raw/detect/orient_mixture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/geometry/subset.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using IndexView = std::span<const std::uint32_t>;

bool is_pair(const SurfaceMixture& mixture) {
  return mixture.surfaces.size() == 2;
}

Surface turned(Surface surface) {
  if (surface.type == SurfaceType::plane) {
    surface.axis = -surface.axis;
  } else {
    surface.concave = !surface.concave;
  }
  return surface;
}

/// Mean cosine between the normals of the points and of each surface.
std::vector<double> mean_cosines(const SurfaceMixture& mixture, IndexView points, const WorkCloud& cloud) {
  const std::vector<double> shares = mixture.shares();
  std::vector<double> cosines(mixture.surfaces.size(), 0);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t s = mixture.surface_of[k];
    if (s == mixture.surfaces.size()) continue;
    const OrientedPoint& p = cloud.points[points[k]];
    cosines[s] +=
        p.normal.dot(normal(mixture.surfaces[s], p.position)) / (shares[s] * static_cast<double>(points.size()));
  }
  return cosines;
}

/// Some of the mixture's points on surfaces, as numbers of positions.
std::vector<std::size_t> some_on_surfaces(const SurfaceMixture& mixture) {
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < mixture.surface_of.size(); ++k) {
    if (mixture.surface_of[k] < mixture.surfaces.size()) numbers.push_back(k);
  }
  return some_of(numbers, k_chunk_points);
}

/// Whether the points of two planes are among each other in projection, unlike those of a step.
bool lie_over_each_other(const SurfaceMixture& pair, IndexView points, const WorkCloud& cloud) {
  const Vector3d across = pair.surfaces[0].axis;
  const std::vector<std::size_t> some = some_on_surfaces(pair);
  double same = 0;
  for (const std::size_t k : some) {
    std::array<double, 3> nearest{};  // squared distance in projection, on either surface or on none
    nearest.fill(std::numeric_limits<double>::infinity());
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (j == k) continue;
      const Vector3d step = cloud.points[points[j]].position - cloud.points[points[k]].position;
      double& least = nearest[pair.surface_of[j]];
      least = std::min(least, step.squaredNorm() - across.dot(step) * across.dot(step));
    }
    const std::size_t own = pair.surface_of[k];
    if (nearest[own] <= nearest[1 - own]) ++same;
  }
  return same < k_own_share * static_cast<double>(some.size());
}

/// Places halfway between two planes, or on the axis or in the centre of a round surface.
std::vector<Vector3d> places_within(const SurfaceMixture& mixture, IndexView points, const WorkCloud& cloud) {
  std::vector<Vector3d> places;
  for (const std::size_t k : some_on_surfaces(mixture)) {
    const Vector3d& p = cloud.points[points[k]].position;
    Surface middle = mixture.surfaces[is_pair(mixture) ? 1 - mixture.surface_of[k] : 0];
    middle.radius = 0;
    const double depth = signed_distance(middle, p) / (is_pair(mixture) ? 2 : 1);
    places.emplace_back(p - depth * normal(middle, p));
  }
  return places;
}

}  // namespace

CloudWinding::CloudWinding(const WorkCloud& cloud, const NeighbourTable& neighbours)
    : cloud_(cloud), areas_(areas_of(neighbours)), whole_({}, {}, {}) {
  std::vector<std::uint32_t> all(cloud.size());
  std::iota(all.begin(), all.end(), 0U);
  whole_ = field_of(all);
}

WindingField CloudWinding::field_of(IndexView points) const {
  Points positions;
  Points normals;
  std::vector<double> areas;
  for (const std::uint32_t i : points) {
    positions.push_back(cloud_.points[i].position);
    normals.push_back(cloud_.points[i].normal);
    areas.push_back(areas_[i]);
  }
  return {positions, normals, areas};
}

double CloudWinding::mean_without(IndexView points, std::span<const Vector3d> places) const {
  const WindingField own = field_of(points);
  double sum = 0;
  for (const Vector3d& place : places) sum += whole_.at(place) - own.at(place);
  return sum / static_cast<double>(places.size());
}

SurfaceMixture oriented(SurfaceMixture mixture, IndexView points, const WorkCloud& cloud, const CloudWinding& winding) {
  constexpr double k_clear_cosine = 0.5;
  const std::vector<double> cosines = mean_cosines(mixture, points, cloud);
  for (std::size_t s = 0; s < cosines.size(); ++s) {
    if (cosines[s] < 0) mixture.surfaces[s] = turned(mixture.surfaces[s]);
  }
  Surface& first = mixture.surfaces.front();
  Surface& last = mixture.surfaces.back();
  const bool is_round = first.type != SurfaceType::plane;
  const bool is_clear = std::ranges::all_of(cosines, [](double c) { return std::abs(c) > k_clear_cosine; });
  const bool is_possible = !is_pair(mixture) || first.axis.dot(last.axis) < 0;
  if (is_clear && is_possible) return mixture;
  if (is_pair(mixture) ? !lie_over_each_other(mixture, points, cloud) : !is_round) return mixture;
  const bool is_hollow = winding.mean_without(points, places_within(mixture, points, cloud)) > 0.5;
  for (Surface& surface : mixture.surfaces) surface.concave = is_round && is_hollow;
  if (is_pair(mixture)) {
    const Vector3d apart = (is_hollow ? -1 : 1) * (last.position - first.position);
    if (first.axis.dot(apart) > 0) first = turned(first);
    if (last.axis.dot(apart) < 0) last = turned(last);
  }
  return mixture;
}

}  // namespace cloud2csg
