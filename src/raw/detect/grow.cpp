#include "raw/detect/grow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/robust_deviation.hpp"
#include "core/geometry/cubes.hpp"
#include "raw/detect/propose.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

/// The largest connected group of agreeing points; empty if it is smaller than the limit.
std::vector<std::uint32_t> connected_points(const Surface& surface, const FreePoints& points,
                                            const SearchLimits& limits) {
  std::vector<std::uint32_t> agreeing;
  for_each_agreeing(
      surface, points.cloud(), limits.agreement, [&](std::uint32_t i) { return points.is_free(i); },
      [&](std::uint32_t i, const Agreement&) { agreeing.push_back(i); });
  if (agreeing.size() < limits.least_points) return {};
  std::vector<std::uint32_t> largest =
      std::move(connected_groups(points.cloud().points, agreeing, limits.link).front());
  return largest.size() < limits.least_points ? std::vector<std::uint32_t>{} : largest;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> connected_groups(std::span<const OrientedPoint> points,
                                                         std::span<const std::uint32_t> indices, double edge) {
  std::vector<std::uint64_t> cubes;
  cubes.reserve(indices.size());
  for (const std::uint32_t i : indices) cubes.push_back(cube_of(points[i].position, edge));
  std::vector<std::vector<std::uint32_t>> groups = connected_groups(cubes);
  for (std::vector<std::uint32_t>& group : groups) {
    for (std::uint32_t& k : group) k = indices[k];
  }
  return groups;
}

FreePoints free_points(const WorkCloud& cloud, const std::vector<GrownSurface>& surfaces) {
  FreePoints points(cloud);
  std::vector<std::uint32_t> taken;
  for (const GrownSurface& surface : surfaces) taken.insert(taken.end(), surface.points.begin(), surface.points.end());
  points.take(taken);
  return points;
}

double support_by(const std::vector<std::uint32_t>& indices, const Surface& surface, const WorkCloud& cloud,
                  const AgreementLimits& limits) {
  return with_agreement(surface, [&, support = limits.support()](const auto& rule) {
    double sum = 0;
    for (const std::uint32_t i : indices) sum += support(rule(cloud.points[i]));
    return sum;
  });
}

std::vector<double> distances_of(const Surface& surface, const WorkCloud& cloud,
                                 std::span<const std::uint32_t> points) {
  return with_agreement(surface, [&](const auto& rule) {
    std::vector<double> distances;
    distances.reserve(points.size());
    for (const std::uint32_t i : points) {
      distances.push_back(rule(cloud.points[i]).distance);
    }
    return distances;
  });
}

std::optional<double> noise_within_patches(std::span<const double> distances) {
  std::vector<double> variances;
  for (std::size_t first = 0; first + k_patch <= distances.size(); first += k_patch) {
    const auto patch = distances.subspan(first, k_patch);
    double sum = 0;
    double squares = 0;
    for (const double d : patch) {
      sum += d;
      squares += d * d;
    }
    variances.push_back(std::max(0.0, squares - sum * sum / k_patch) / (k_patch - 1));
  }
  return variances.empty() ? std::nullopt : std::optional(std::sqrt(median_of(variances)));
}

double preference(SurfaceType type) {
  switch (type) {
    case SurfaceType::plane:
      return 1.0;
    case SurfaceType::sphere:
    case SurfaceType::cylinder:
      return 0.97;
    case SurfaceType::cone:
      return 0.9;
    case SurfaceType::torus:
      return 0.85;
  }
  return 0;
}

double reach_of(const Surface& surface, const WorkCloud& cloud, std::span<const std::uint32_t> points,
                const AgreementLimits& limits) {
  const double least = k_deviations * limits.noise;
  if (points.empty() || least >= limits.distance) return limits.distance;
  std::vector<double> distances = distances_of(surface, cloud, points);
  for (double& d : distances) d = std::abs(d);
  return std::clamp(k_deviations * robust_deviation(distances), least, limits.distance);
}

std::optional<GrownSurface> grow_surface(const Surface& start, const FreePoints& points, const SearchLimits& limits) {
  // Loose limits at first, because a start from few points is still inaccurate.
  SearchLimits wide = limits;
  wide.agreement.distance *= 1.5;
  std::vector<std::uint32_t> seen = connected_points(start, points, wide);
  GrownSurface best{.surface = start, .points = {}, .reach = reach_of(start, points.cloud(), seen, limits.agreement)};
  for (int round = 0; round < k_rounds && !seen.empty(); ++round) {
    const std::optional<Surface> fitted =
        fit_plausible(best.surface, points.cloud().some_of(seen, k_sample), limits.agreement.within(best.reach));
    if (!fitted) break;
    seen = connected_points(*fitted, points, limits);
    const double support = support_by(seen, *fitted, points.cloud(), limits.agreement);
    if (support <= best.support) break;
    const double reach = reach_of(*fitted, points.cloud(), seen, limits.agreement);
    best = {.surface = *fitted, .points = seen, .support = support, .reach = reach};
  }
  if (!best.points.empty() && best.reach < limits.agreement.distance) {
    SearchLimits own = limits;
    own.agreement = limits.agreement.within(best.reach);
    best.points = connected_points(best.surface, points, own);
    best.support = support_by(best.points, best.surface, points.cloud(), limits.agreement);
  }
  return best.points.empty() ? std::nullopt : std::optional(std::move(best));
}

GrownSurface with_best_round_type(GrownSurface grown, const FreePoints& points, const SearchLimits& limits) {
  constexpr std::array k_round{SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::cone, SurfaceType::torus};
  const bool is_within_noise = grown.reach <= k_deviations * limits.agreement.noise;
  if (grown.surface.type == SurfaceType::plane && is_within_noise) return grown;
  // Uses a wider band, because the own points fit the surface too well to show its true type.
  SearchLimits wide = limits;
  wide.agreement.distance *= 4;
  const std::vector<OrientedPoint> around =
      points.cloud().some_of(connected_points(grown.surface, points, wide), k_sample);
  const auto value = [](const Surface& surface, double support) { return preference(surface.type) * support; };
  for (const SurfaceType type : k_round) {
    if (type == grown.surface.type) continue;
    const std::optional<Surface> other = estimate_plausible(type, around, limits.agreement);
    if (!other || value(*other, support_of(*other, around, limits.agreement)) <=
                      value(grown.surface, support_of(grown.surface, around, limits.agreement))) {
      continue;
    }
    std::optional<GrownSurface> result = grow_surface(*other, points, limits);
    if (result && value(result->surface, result->support) > value(grown.surface, grown.support)) {
      grown = std::move(*result);
    }
  }
  return grown;
}

GrownSurface with_simplest_type(GrownSurface grown, const FreePoints& points, const SearchLimits& limits) {
  constexpr std::array k_simplest_first{SurfaceType::plane, SurfaceType::sphere, SurfaceType::cylinder,
                                        SurfaceType::cone};
  const std::vector<OrientedPoint> sample = points.cloud().some_of(grown.points, k_sample);
  const double support = support_of(grown.surface, sample, limits.agreement);
  for (const SurfaceType type : k_simplest_first) {
    if (preference(type) <= preference(grown.surface.type)) break;
    const std::optional<Surface> simpler = estimate_plausible(type, sample, limits.agreement);
    if (!simpler || support_of(*simpler, sample, limits.agreement) < k_nearly_all * support) continue;
    std::optional<GrownSurface> result = grow_surface(*simpler, points, limits);
    if (result && result->support >= k_nearly_all * grown.support) return std::move(*result);
  }
  return grown;
}

}  // namespace cloud2csg
