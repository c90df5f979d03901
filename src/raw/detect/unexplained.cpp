#include "raw/detect/unexplained.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/parallel.hpp"
#include "raw/prepare/constants.hpp"
#include "raw/prepare/local_fit.hpp"
#include "raw/prepare/orientation.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// Free points among the nearest of a free point, without which it strayed from a surface. At 1, points that the noise
/// carried off their surfaces take time; at 4, one more cylinder is lost.
constexpr std::size_t k_least_free = 2;
/// Tolerance of a local plane, relative to its radius. Bands are often as narrow as their curvature is sharp.
constexpr double k_bend = 0.25;

/// The free points that lie together, and all nearest points of these. Ascending.
std::vector<std::uint32_t> points_together(const FreePoints& points, const NeighbourTable& neighbours) {
  std::vector<std::uint32_t> together;
  const auto is_free = [&](std::uint32_t i) { return points.is_free(i); };
  for (const std::uint32_t point : points.list()) {
    const std::span<const std::uint32_t> near = neighbours.nearest(point, k_voters);
    if (std::count_if(near.begin(), near.end(), is_free) < static_cast<std::ptrdiff_t>(k_least_free)) continue;
    together.push_back(point);
    together.insert(together.end(), near.begin(), near.end());
  }
  std::sort(together.begin(), together.end());
  together.erase(std::unique(together.begin(), together.end()), together.end());
  return together;
}

/// Fits normals to the points alone, on the side of their old ones. k_voters are few enough for a band of three rows.
void estimate_normals_among(std::vector<OrientedPoint>& points, const Points& positions, double noise,
                            const RunContext& run) {
  const NeighbourTable near = find_neighbours(positions, NeighbourTree(positions), k_voters, run);
  if (near.width < 3) return;
  for_each_index(points.size(), run, [&](std::size_t k) {
    const Vector3d normal = fit_local_plane(positions, k, near, noise / points[k].precision, k_bend).normal;
    points[k].normal = normal.dot(points[k].normal) < 0 ? Vector3d(-normal) : normal;
  });
}

/// Turns the normals of the part so that they agree with those of the explained points around it, across its edges.
void orient_part(WorkCloud& part, const FreePoints& points, const NeighbourTable& neighbours) {
  std::vector<Vector3d> normals(points.cloud().size(), Vector3d::Zero());  // zero: not known yet
  for (std::uint32_t i = 0; i < normals.size(); ++i) {
    if (!points.is_free(i)) normals[i] = points[i].normal;
  }
  for (int sweep = 0; sweep < k_rounds; ++sweep) {
    for (std::size_t k = 0; k < part.size(); ++k) {
      OrientedPoint& point = part.points[k];
      double votes = 0;
      for (const std::uint32_t j : neighbours.nearest(part.index[k], k_voters)) {
        const double vote = agreement(points[j].position - point.position, point.normal, normals[j]);
        votes += vote * vote * vote;
      }
      if (votes < 0) point.normal = -point.normal;
    }
    for (std::size_t k = 0; k < part.size(); ++k) {
      if (points.is_free(part.index[k])) normals[part.index[k]] = part.points[k].normal;
    }
  }
}

}  // namespace

WorkCloud unexplained_part(const FreePoints& points, const NeighbourTable& neighbours, double noise,
                           const RunContext& run) {
  const WorkCloud& cloud = points.cloud();
  WorkCloud part{.points = {},
                 .code = {},
                 .index = points_together(points, neighbours),
                 .runs = {},
                 .middle = cloud.middle,
                 .diagonal = cloud.diagonal};
  for (const std::uint32_t i : part.index) {
    part.points.push_back(cloud.points[i]);
    part.code.push_back(cloud.code[i]);
  }
  part.runs = runs_of(part.points);
  if (part.points.empty()) return part;
  estimate_normals_among(part.points, cloud.positions_of(part.index), noise, run);
  orient_part(part, points, neighbours);
  return part;
}

std::vector<OwnNormal> turn_normals(WorkCloud& cloud, const std::vector<GrownSurface>& surfaces,
                                    const NeighbourTable& neighbours) {
  constexpr std::size_t k_several = std::numeric_limits<std::size_t>::max();
  const std::vector<std::uint32_t> free = free_points(cloud, surfaces).list();
  std::vector<std::size_t> surface_of(free.size(), surfaces.size());
  std::vector<std::uint8_t> is_on(cloud.size(), 0);  // the surface in turn
  for (std::size_t number = 0; number < surfaces.size(); ++number) {
    const GrownSurface& s = surfaces[number];
    const std::vector<double> distances = distances_of(s.surface, cloud, free);
    const auto mark = [&](bool value) {
      for (const std::uint32_t i : s.points) is_on[i] = value ? 2 : 0;
      for (std::size_t k = 0; k < free.size(); ++k) {
        if (std::abs(distances[k]) <= s.reach) is_on[free[k]] = value ? 1 : 0;
      }
    };
    mark(true);
    for (std::size_t k = 0; k < free.size(); ++k) {
      if (is_on[free[k]] == 0) continue;
      const std::span<const std::uint32_t> near = neighbours.of(free[k]);
      const auto on = std::ranges::count_if(near, [&](std::uint32_t j) { return is_on[j] != 0; });
      const bool is_beside = std::ranges::any_of(near, [&](std::uint32_t j) { return is_on[j] == 2; });
      if (2 * on <= std::ssize(near) || !is_beside) continue;
      surface_of[k] = surface_of[k] == surfaces.size() ? number : k_several;
    }
    mark(false);
  }
  std::vector<OwnNormal> turned;
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (surface_of[k] >= surfaces.size()) continue;
    OrientedPoint& point = cloud.points[free[k]];
    turned.push_back({.point = free[k], .normal = point.normal});
    point.normal = normal(surfaces[surface_of[k]].surface, point.position);
  }
  return turned;
}

void turn_back(WorkCloud& cloud, const std::vector<OwnNormal>& normals, const std::vector<GrownSurface>& surfaces) {
  const FreePoints points = free_points(cloud, surfaces);
  for (const OwnNormal& own : normals) {
    if (points.is_free(own.point)) cloud.points[own.point].normal = own.normal;
  }
}

}  // namespace cloud2csg
