#include "raw/detect/find_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/base/robust_deviation.hpp"
#include "raw/detect/local_noise.hpp"
#include "raw/detect/propose.hpp"
#include "raw/detect/unexplained.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

constexpr std::uint64_t k_propose_stage = 0x70726f70;
constexpr std::uint64_t k_subset_stage = 0x73756273;

/// The candidates with the most support in a random subset, the best first.
std::vector<Surface> best_candidates(const FreePoints& points, const SearchLimits& limits, std::size_t draws,
                                     std::uint64_t seed, std::uint64_t round, const RunContext& run) {
  std::vector<std::vector<Surface>> proposed(draws);
  for_each_index(draws, run, [&](std::size_t i) {
    RandomStream random(seed, k_propose_stage, round, i);
    proposed[i] = propose_surfaces(points, limits.agreement, random);
  });
  std::vector<Surface> candidates;
  for (const auto& some : proposed) candidates.insert(candidates.end(), some.begin(), some.end());

  RandomStream random(seed, k_subset_stage, round);
  const std::vector<OrientedPoint> subset = points.draw(k_large_sample, random);
  std::vector<double> scores(candidates.size());
  for_each_index(candidates.size(), run, [&](std::size_t i) {
    scores[i] = preference(candidates[i].type) * support_of(candidates[i], subset, limits.agreement);
  });
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
  std::vector<Surface> best;
  for (std::size_t k = 0; k < std::min(k_best, order.size()); ++k) best.push_back(candidates[order[k]]);
  return best;
}

std::optional<GrownSurface> find_one(const FreePoints& points, const SearchLimits& limits, std::size_t draws,
                                     std::uint64_t seed, std::uint64_t round, const RunContext& run) {
  const std::vector<Surface> candidates = best_candidates(points, limits, draws, seed, round, run);
  std::vector<std::optional<GrownSurface>> grown(candidates.size());
  for_each_index(candidates.size(), run,
                 [&](std::size_t i) { grown[i] = grow_surface(candidates[i], points, limits); });
  std::erase_if(grown, [](const auto& g) { return !g; });
  if (grown.empty()) return std::nullopt;
  const auto value = [](const std::optional<GrownSurface>& g) { return preference(g->surface.type) * g->support; };
  const auto best =
      std::max_element(grown.begin(), grown.end(), [&](const auto& a, const auto& b) { return value(a) < value(b); });
  return with_simplest_type(with_best_round_type(std::move(**best), points, limits), points, limits);
}

/// Every point is evidence.
bool always(std::uint32_t /*point*/) {
  return true;
}

/// The noise that tells surfaces apart. Files give at least five digits, so less counts as exact.
double detection_noise(const DetectOptions& options, const Scale& scale) {
  constexpr double k_exact_share = 1e-5;
  if (options.distance_tolerance) return *options.distance_tolerance / k_deviations;
  return std::max(scale.noise, k_exact_share * scale.diagonal);
}

/// The option's value, or the fewest points of a plane that are no chance. A patch of n points is sqrt(n) spacings
/// wide. A point at random in it lies within the tolerance of a surface with the chance of the band's share of the
/// width. The parameters fit some of the points anyway; all others must be as unlikely as one in a million.
std::size_t least_points_of(const DetectOptions& options, const Scale& scale, std::size_t cloud_points) {
  // 10 points suffice in an exact cloud whose spacing is 1 % of the diagonal. With half the evidence, 7 do; with
  // double, 15.
  constexpr std::size_t k_parameters = count_parameters(SurfaceType::plane);
  if (options.least_points) return *options.least_points;
  const double band = 2 * detection_tolerance(options, scale);
  std::size_t points = k_parameters + 1;
  const auto evidence = [&] {
    return static_cast<double>(points - k_parameters) *
           std::log(std::sqrt(static_cast<double>(points)) * scale.spacing / band);
  };
  while (points <= cloud_points && !(evidence() >= k_evidence)) ++points;
  return points;
}

/// In a cloud of diagonal 1: the option's value, up to the radius that counts as flat.
double most_radius_of(const DetectOptions& options, double diagonal) {
  return options.most_size ? std::min(k_flat_radius, *options.most_size / diagonal) : k_flat_radius;
}

SearchLimits limits_of(const DetectOptions& options, const Scale& scale, const WorkCloud& work) {
  constexpr double k_link_in_spacings = 4;
  const double tolerance = detection_tolerance(options, scale);
  return {.agreement = {.distance = tolerance / work.diagonal,
                        .noise = detection_noise(options, scale) / work.diagonal,
                        .cosine = std::cos(options.angle_tolerance_deg * std::numbers::pi / 180),
                        .most_radius = most_radius_of(options, work.diagonal)},
          .link = std::max(k_link_in_spacings * scale.spacing, 2 * tolerance) / work.diagonal,
          .least_points = least_points_of(options, scale, work.size()),
          .is_least_given = options.least_points.has_value(),
          .is_distance_given = options.distance_tolerance.has_value()};
}

/// Noise of the points of the median plane, which is weighted by points; absent if planes have few points. Other
/// surfaces may have form errors, such as facets. Free points within twice the tolerance count, too, so the noise may
/// be larger than the limits assume: where neighbours have similar errors, as in smoothed meshes, local fits follow
/// these errors, and only whole surfaces show them. O(points x planes)
std::optional<double> noise_of_planes(const std::vector<GrownSurface>& surfaces, const FreePoints& points,
                                      const AgreementLimits& limits) {
  AgreementLimits wide = limits;
  wide.distance *= 2;
  std::vector<double> noises;  // by point
  for (const GrownSurface& plane : surfaces) {
    if (plane.surface.type != SurfaceType::plane) continue;
    const std::vector<std::uint32_t> near =
        points_near(plane, points.cloud(), wide, [&](std::uint32_t i) { return points.is_free(i); });
    const std::optional<double> noise = noise_within_patches(distances_of(plane.surface, points.cloud(), near));
    if (noise) noises.insert(noises.end(), plane.points.size(), *noise);
  }
  return noises.size() < k_sample ? std::nullopt : std::optional(median_of(noises));
}

/// Half of it may miss the planes of a round part; double takes longer where the noise is more than assumed.
constexpr std::size_t k_first_surfaces = 4;

/// The first few surfaces, and limits by the noise that they show. Finds them again if it is clearly more than assumed.
/// It is at least `least_noise`.
FirstSurfaces find_largest(const WorkCloud& cloud, Scale scale, double least_noise, const DetectOptions& options,
                           const RunContext& run) {
  for (int round = 1;; ++round) {
    const SearchLimits limits = limits_of(options, scale, cloud);
    FreePoints points(cloud);
    std::vector<GrownSurface> found =
        find_all(points, limits, options.seed, always, run, {}, {.most = k_first_surfaces});
    const auto noise = options.distance_tolerance ? std::nullopt : noise_of_planes(found, points, limits.agreement);
    if (noise) scale.noise = std::max(*noise * cloud.diagonal, least_noise);
    if (noise && limits.agreement.noise < k_clear_share * *noise && round < k_rounds) continue;
    return {.scale = scale, .limits = limits_of(options, scale, cloud), .surfaces = std::move(found)};
  }
}

/// Finds all surfaces after the largest, then more among the points that are left, by normals of their own. Points that
/// the first surfaces explain are no evidence for a later one. Only its other points get the new normals.
std::vector<GrownSurface> find_in_two_passes(WorkCloud& cloud, const NeighbourTable& neighbours,
                                             std::vector<GrownSurface> largest, const SearchLimits& limits,
                                             std::uint64_t seed, const RunContext& run, const StageShare& share) {
  const double first_pass = 0.8;  // of the time, roughly
  FreePoints points = free_points(cloud, largest);
  std::vector<GrownSurface> found =
      find_all(points, limits, seed, always, run, share.part(0, first_pass), {.found = std::move(largest)});
  if (points.list().size() < limits.least_points) return found;
  const WorkCloud part = unexplained_part(points, neighbours, limits.agreement.noise, run);
  FreePoints of_part(part);
  const auto is_unexplained = [&](std::uint32_t k) { return points.is_free(part.index[k]); };
  for (GrownSurface& surface : find_all(of_part, limits, seed, is_unexplained, run, share.part(first_pass, 1))) {
    for (std::uint32_t& k : surface.points) {
      if (is_unexplained(k)) cloud.points[part.index[k]].normal = part.points[k].normal;
      k = part.index[k];
    }
    found.push_back(std::move(surface));
  }
  return found;
}

}  // namespace

std::vector<GrownSurface> find_all(FreePoints& points, const SearchLimits& limits, std::uint64_t seed,
                                   const IsEvidence& is_evidence, const RunContext& run, const StageShare& share,
                                   SearchStart start) {
  constexpr std::size_t k_draws = 64;
  const auto count = static_cast<double>(points.cloud().size());
  std::vector<GrownSurface> found = std::move(start.found);
  int in_vain = 0;
  for (std::uint64_t round = found.size(); in_vain < k_rounds && points.list().size() >= limits.least_points; ++round) {
    if (found.size() == start.most) break;
    run.throw_if_stopped();
    share.report(run, 1 - static_cast<double>(points.list().size()) / count);
    std::optional<GrownSurface> surface = find_one(points, limits, k_draws << in_vain, seed, round, run);
    ++in_vain;
    if (!surface) continue;
    const auto evidence = std::count_if(surface->points.begin(), surface->points.end(), is_evidence);
    const bool is_enough = static_cast<std::size_t>(evidence) >= limits.least_points_of(surface->surface.type);
    if (!is_enough) std::erase_if(surface->points, is_evidence);
    points.take(surface->points);
    if (!is_enough) continue;
    in_vain = 0;
    found.push_back(std::move(*surface));
  }
  return found;
}

FirstSurfaces find_surfaces(WorkCloud& cloud, const NeighbourTable& neighbours, Scale scale,
                            const DetectOptions& options, const RunContext& run, const StageShare& share) {
  double least_noise = 0;
  for (int round = 1;; ++round) {
    FirstSurfaces first = find_largest(cloud, scale, least_noise, options, run);
    scale = first.scale;
    const std::vector<OrientedPoint> before = cloud.points;
    first.surfaces = find_in_two_passes(cloud, neighbours, std::move(first.surfaces), first.limits, options.seed, run,
                                        round == 1 ? share : StageShare{});
    if (options.distance_tolerance || round == k_rounds) return first;
    const std::vector<double> noise = local_noise(first.surfaces, cloud, first.limits.agreement, run);
    if (noise.empty()) return first;
    cloud.points = before;
    Scale exact = scale;
    exact.noise = 0;
    least_noise = detection_tolerance({}, exact) / k_deviations;
    scale.noise = std::max(scale.noise, least_noise);
    account_for_noise(cloud, noise, scale, run);
  }
}

}  // namespace cloud2csg
