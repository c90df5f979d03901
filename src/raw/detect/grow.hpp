#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "raw/detect/agreement.hpp"
#include "raw/detect/work_cloud.hpp"

namespace cloud2csg {

/// Connected groups of these points, largest first. Connected: in one cube of this edge or touching cubes. O(n log n)
[[nodiscard]] std::vector<std::vector<std::uint32_t>> connected_groups(std::span<const OrientedPoint> points,
                                                                       std::span<const std::uint32_t> indices,
                                                                       double edge);

struct SearchLimits {
  AgreementLimits agreement;
  double link;                     ///< edge for connected_groups()
  std::size_t least_points;        ///< in a plane, the simplest surface
  bool is_least_given = false;     ///< whether all types need as many
  bool is_distance_given = false;  ///< then nearer surfaces are one

  /// A surface with more parameters needs as many more points.
  [[nodiscard]] std::size_t least_points_of(SurfaceType type) const {
    return is_least_given ? least_points : least_points + count_parameters(type) - count_parameters(SurfaceType::plane);
  }
};

/// A surface with its points: ascending indices into the WorkCloud.
struct GrownSurface {
  Surface surface;
  std::vector<std::uint32_t> points;
  double support = 0;                         ///< see support_of()
  double reach = 0;                           ///< distance within which its points lie: see reach_of()
  std::vector<std::uint32_t> fitted_to = {};  ///< the points of the last fit while surfaces settle
};

/// By point of the cloud: the number of the surface, or of another set with `.points`, that has it; their count if none
/// has. O(n)
template <class Set>
std::vector<std::size_t> owners_of_points(const std::vector<Set>& sets, const WorkCloud& cloud) {
  std::vector<std::size_t> owners(cloud.size(), sets.size());
  for (std::size_t s = 0; s < sets.size(); ++s) {
    for (const std::uint32_t i : sets[s].points) owners[i] = s;
  }
  return owners;
}

/// Points on none of the surfaces. O(n)
[[nodiscard]] FreePoints free_points(const WorkCloud& cloud, const std::vector<GrownSurface>& surfaces);

/// Sum of the points' support: see support_of(). O(indices)
[[nodiscard]] double support_by(const std::vector<std::uint32_t>& indices, const Surface& surface,
                                const WorkCloud& cloud, const AgreementLimits& limits);

/// Signed distances of the points from the surface times their precision. O(n)
[[nodiscard]] std::vector<double> distances_of(const Surface& surface, const WorkCloud& cloud,
                                               std::span<const std::uint32_t> points);

/// Three robust standard deviations of the points that agree with the surface, between those of the noise and the
/// limit. A surface with form errors, such as facets, reaches farther than an exact one. O(n)
[[nodiscard]] double reach_of(const Surface& surface, const WorkCloud& cloud, std::span<const std::uint32_t> points,
                              const AgreementLimits& limits);

/// Those of the points that lie beyond the reach of all surfaces with counts(number). O(points x surfaces)
template <class Counts>
std::vector<std::uint32_t> beyond_reach(std::vector<std::uint32_t> points, const std::vector<GrownSurface>& surfaces,
                                        const WorkCloud& cloud, const Counts& counts) {
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (!counts(s)) continue;
    const std::vector<double> distances = distances_of(surfaces[s].surface, cloud, points);
    std::size_t left = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (std::abs(distances[k]) > surfaces[s].reach) points[left++] = points[k];
    }
    points.resize(left);
  }
  return points;
}

/// Standard deviation of the points around the mean of their patch, of the median patch. The distances are those of
/// successive points, which are near each other. Absent if they are fewer than a patch. O(n)
[[nodiscard]] std::optional<double> noise_within_patches(std::span<const double> distances);

/// The surface's points and others within the limits, ascending, of those with is_wanted(index). Precondition: its own
/// points are not wanted.
template <class IsWanted>
std::vector<std::uint32_t> points_near(const GrownSurface& grown, const WorkCloud& cloud, const AgreementLimits& limits,
                                       const IsWanted& is_wanted) {
  std::vector<std::uint32_t> points;
  for_each_agreeing(grown.surface, cloud, limits, is_wanted,
                    [&](std::uint32_t i, const Agreement&) { points.push_back(i); });
  const auto middle = points.insert(points.end(), grown.points.begin(), grown.points.end());
  std::inplace_merge(points.begin(), middle, points.end());
  return points;
}

/// Weight of a type. A simpler type wins over a more flexible one that explains a few more points.
[[nodiscard]] double preference(SurfaceType type);

/// Alternates between taking the connected agreeing points and fitting to them, while the points increase. Absent if
/// there are fewer than the limit. The points are those within the surface's reach. O(free points)
[[nodiscard]] std::optional<GrownSurface> grow_surface(const Surface& start, const FreePoints& points,
                                                       const SearchLimits& limits);

/// The surface, or one of another round type that explains its points and those around it better. Locally a slender
/// cone looks like a cylinder, and a narrow band of a cylinder like a sphere. A plane within the noise stays one; a
/// strip of a flat cone fits a plane less well.
[[nodiscard]] GrownSurface with_best_round_type(GrownSurface grown, const FreePoints& points,
                                                const SearchLimits& limits);

/// The same points as a surface of a simpler type, if it explains nearly as many.
[[nodiscard]] GrownSurface with_simplest_type(GrownSurface grown, const FreePoints& points, const SearchLimits& limits);

}  // namespace cloud2csg
