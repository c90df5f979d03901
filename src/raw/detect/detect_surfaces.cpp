#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/run_context.hpp"
#include "core/base/run.hpp"
#include "raw/detect/find_surfaces.hpp"
#include "raw/detect/grow.hpp"
#include "raw/detect/mixed_surfaces.hpp"
#include "raw/detect/recombine_surfaces.hpp"
#include "raw/detect/settle_surfaces.hpp"
#include "raw/detect/smoothing.hpp"
#include "raw/detect/split_surfaces.hpp"
#include "raw/detect/unexplained.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

/// Settles all surfaces, and again where wrong or mixed ones were replaced.
std::vector<GrownSurface> settled(std::vector<GrownSurface> surfaces, WorkCloud& cloud,
                                  const NeighbourTable& neighbours, const SearchLimits& limits, const RunContext& run) {
  surfaces = settle_surfaces(std::move(surfaces), cloud, neighbours, limits, run);
  MixedSurfaces mixed = replace_mixed_surfaces(std::move(surfaces), cloud, neighbours, limits, run);
  surfaces = std::move(mixed.surfaces);
  if (!mixed.turned.empty()) surfaces = settle_surfaces(std::move(surfaces), cloud, neighbours, limits, run);
  for (int round = 0; round < k_rounds && !limits.is_distance_given; ++round) {
    std::optional<std::vector<GrownSurface>> better = recombined(surfaces, cloud, neighbours, limits, run);
    if (!better) break;
    surfaces = settle_surfaces(std::move(*better), cloud, neighbours, limits, run);
  }
  turn_back(cloud, mixed.turned, surfaces);
  return surfaces;
}

/// Settles surfaces. Where surfaces did not last, more points are free than were searched in vain: then it finds more
/// among the free ones. A free point within reach of a surface is no evidence: it has another normal, as points along
/// an edge may have. Ends with a round that leaves about as many points free as the one before did, give or take fewer
/// than make a surface. New surfaces may take points from a good one until it does not last: a round that leaves more
/// points free is undone.
std::vector<GrownSurface> settle_and_find_more(std::vector<GrownSurface> surfaces, WorkCloud& cloud,
                                               const NeighbourTable& neighbours, const SearchLimits& limits,
                                               std::uint64_t seed, const RunContext& run) {
  std::vector<GrownSurface> before;
  std::vector<OrientedPoint> points_before;  // with the normals that belong to the surfaces
  std::size_t free_before = cloud.size() + limits.least_points;
  for (int round = 1;; ++round) {
    const std::size_t searched = free_points(cloud, surfaces).list().size();
    surfaces = settled(std::move(surfaces), cloud, neighbours, limits, run);
    FreePoints points = free_points(cloud, surfaces);
    const std::size_t free = points.list().size();
    if (free >= free_before + limits.least_points) {
      cloud.points = std::move(points_before);
      return before;
    }
    const bool is_like_before = free + limits.least_points > free_before;
    if (round == k_rounds || is_like_before || free < searched + limits.least_points) return surfaces;
    before = surfaces;
    points_before = cloud.points;
    free_before = free;
    const auto off = beyond_reach(points.list(), surfaces, cloud, [](std::size_t) { return true; });
    const auto is_evidence = [&](std::uint32_t i) { return std::ranges::binary_search(off, i); };
    std::vector<GrownSurface> more = find_all(points, limits, seed, is_evidence, run);
    if (more.empty()) return surfaces;
    std::ranges::move(more, std::back_inserter(surfaces));
  }
}

Surface in_the_cloud(Surface surface, const WorkCloud& work) {
  surface.position = surface.position * work.diagonal + work.middle;
  surface.radius *= work.diagonal;
  surface.minor_radius *= work.diagonal;
  return surface;
}

double rms_distance(const GrownSurface& grown, const WorkCloud& work) {
  double sum = 0;
  for (const std::uint32_t i : grown.points) {
    const double distance = signed_distance(grown.surface, work.points[i].position);
    sum += distance * distance;
  }
  return std::sqrt(sum / static_cast<double>(grown.points.size()));
}

/// Uncertainty of the axis in degrees, which is large for a short piece of a pipe.
double turn_of(const GrownSurface& grown, const WorkCloud& work) {
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> precisions;
  for (const OrientedPoint& p : work.some_of(grown.points, k_sample)) {
    positions.push_back(p.position);
    precisions.push_back(p.precision);
  }
  const std::optional<SurfaceFit> fit = fit_surface(grown.surface, positions, {.precisions = precisions});
  return fit ? fit->uncertainty.axis * 180 / std::numbers::pi : 0;
}

DetectedSurface detected(const GrownSurface& grown, const WorkCloud& work) {
  DetectedSurface result{.surface = in_the_cloud(grown.surface, work),
                         .points = {},
                         .rms = rms_distance(grown, work) * work.diagonal,
                         .turn_deg = turn_of(grown, work)};
  result.points.reserve(grown.points.size());
  for (const std::uint32_t i : grown.points) result.points.push_back(work.index[i]);
  std::sort(result.points.begin(), result.points.end());
  return result;
}

/// Whether a surface's size is within the options' limits. Surfaces outside are dropped only after detection, so that
/// no others replace them: no strips of planes for a small bore.
bool has_allowed_size(const GrownSurface& grown, const WorkCloud& work, const DetectOptions& options, double link) {
  if (!options.least_size && !options.most_size) return true;
  const SurfaceType type = grown.surface.type;
  const bool has_radius = type == SurfaceType::sphere || type == SurfaceType::cylinder || type == SurfaceType::torus;
  const double extent = work.extent_of(connected_groups(work.points, grown.points, link).front());
  double least = extent;
  double most = extent;
  if (has_radius) {
    least = std::min(least, type == SurfaceType::torus ? grown.surface.minor_radius : grown.surface.radius);
    most = std::max({most, grown.surface.radius, grown.surface.minor_radius});
  }
  return least * work.diagonal >= options.least_size.value_or(0) &&
         (!options.most_size || most * work.diagonal <= *options.most_size);
}

}  // namespace

std::optional<OptionConflict> conflict_in(const DetectOptions& options) {
  if (!options.least_size || !options.most_size || *options.least_size <= *options.most_size) return std::nullopt;
  return OptionConflict{"least_size", fmt::format("expected no more than `most_size`, found {} and {}",
                                                  *options.least_size, *options.most_size)};
}

double detection_tolerance(const DetectOptions& options, const Scale& scale) {
  constexpr double k_least_share = 0.0015;
  return options.distance_tolerance.value_or(std::max(k_deviations * scale.noise, k_least_share * scale.diagonal));
}

Detection detect_surfaces(const PointCloud& cloud, const Scale& scale, const DetectOptions& options,
                          const RunContext& run) {
  validate(options);
  WorkCloud work = make_work_cloud(cloud);
  const StageShare share("detect", cloud.size(), "points");
  const NeighbourTable neighbours = work.neighbours(run);
  FirstSurfaces first = find_surfaces(work, neighbours, scale, options, run, share);
  const SearchLimits limits = first.limits;
  Detection result{.surfaces = {},
                   .unexplained = cloud.size(),
                   .noise = first.scale.noise,
                   .distance_tolerance = detection_tolerance(options, first.scale)};
  std::vector<GrownSurface> surfaces =
      settle_and_find_more(std::move(first.surfaces), work, neighbours, limits, options.seed, run);
  const double smoothing = limits.is_distance_given ? 0 : smoothing_length(surfaces, work, limits.agreement.noise);
  if (smoothing > 0) {
    surfaces = settle_surfaces(without_smoothed_edges(std::move(surfaces), work, smoothing, limits, run), work,
                               neighbours, limits, run);
    const FreePoints points = free_points(work, surfaces);
    for (const std::uint32_t i : points_at_edges(points.list(), surfaces, work, smoothing, run)) {
      result.smoothed.push_back(work.index[i]);
    }
    std::ranges::sort(result.smoothed);
  } else if (!limits.is_distance_given) {  // neighbours have independent errors
    surfaces = split_surfaces(std::move(surfaces), work, limits, run);
  }
  for (const GrownSurface& grown : surfaces) {
    if (!has_allowed_size(grown, work, options, limits.link)) continue;
    result.surfaces.push_back(detected(grown, work));
    result.unexplained -= grown.points.size();
  }
  share.report(run, 1);
  return result;
}

}  // namespace cloud2csg
