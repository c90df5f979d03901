#include "raw/detect/settle_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "core/base/parallel.hpp"
#include "raw/detect/propose.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

bool explains(const Surface& surface, const std::vector<OrientedPoint>& points, const AgreementLimits& limits,
              double share) {
  return static_cast<double>(count_agreeing(surface, points, limits)) >= share * static_cast<double>(points.size());
}

/// One surface for the points of both, if it exists.
std::optional<GrownSurface> joined(const GrownSurface& a, const GrownSurface& b, const WorkCloud& cloud,
                                   const AgreementLimits& all_limits) {
  const AgreementLimits limits = all_limits.within(std::max(a.reach, b.reach));
  if (a.surface.type != b.surface.type || a.surface.concave != b.surface.concave) return std::nullopt;
  const std::vector<OrientedPoint> of_a = cloud.some_of(a.points, k_sample);
  const std::vector<OrientedPoint> of_b = cloud.some_of(b.points, k_sample);
  // A fit is reliable only near its own points, so this test is loose. The common fit must explain nearly all points.
  AgreementLimits wide = limits;
  wide.distance *= 3;
  if (!explains(a.surface, of_b, wide, 0.5) && !explains(b.surface, of_a, wide, 0.5)) return std::nullopt;
  std::vector<OrientedPoint> of_both = of_a;
  of_both.insert(of_both.end(), of_b.begin(), of_b.end());
  const std::optional<Surface> fitted = fit_plausible(a.surface, of_both, limits);
  if (!fitted || !explains(*fitted, of_a, limits, k_nearly_all) || !explains(*fitted, of_b, limits, k_nearly_all)) {
    return std::nullopt;
  }
  GrownSurface both{.surface = *fitted, .points = {}, .support = a.support + b.support, .reach = limits.distance};
  std::set_union(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), std::back_inserter(both.points));
  return both;
}

/// @throws Cancelled
void join_all(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, const AgreementLimits& limits,
              const RunContext& run) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    run.throw_if_stopped();
    for (std::size_t j = i + 1; j < surfaces.size();) {
      std::optional<GrownSurface> both = joined(surfaces[i], surfaces[j], cloud, limits);
      if (!both) {
        ++j;
        continue;
      }
      surfaces[i] = std::move(*both);
      surfaces.erase(surfaces.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;
    }
  }
}

/// Gives each surface all agreeing points, whoever found them first: the true surface of a face gets all of it.
/// @returns the points' distances, by surface
std::vector<std::vector<double>> claim_all(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                           const AgreementLimits& limits, const RunContext& run) {
  std::vector<std::vector<double>> distances(surfaces.size());
  for_each_index(surfaces.size(), run, [&](std::size_t k) {
    GrownSurface& surface = surfaces[k];
    surface.points.clear();
    surface.support = 0;
    const auto always = [](std::uint32_t) { return true; };
    for_each_agreeing(surface.surface, cloud, limits.within(surface.reach), always,
                      [&](std::uint32_t i, const Agreement& agreement) {
                        surface.points.push_back(i);
                        surface.support += limits.support(agreement);
                        distances[k].push_back(std::abs(agreement.distance));
                      });
  });
  return distances;
}

/// Costs of the points on a surface with this noise, if their normals are not on another side of an edge.
std::vector<double> costs_of(const Surface& surface, const std::vector<OrientedPoint>& points, double noise) {
  // Estimated normals near an edge are between those of its faces: 45 degrees off both, give or take their noise.
  constexpr double k_edge_cosine = 0.5;
  return with_agreement(surface, [&](const auto& rule) {
    std::vector<double> costs;
    costs.reserve(points.size());
    for (const OrientedPoint& p : points) {
      const Agreement agreement = rule(p.position, p.normal);
      costs.push_back(cost_of(agreement.cosine >= k_edge_cosine ? agreement.distance : k_deviations * noise, noise));
    }
    return costs;
  });
}

/// Logarithm of the ratio of the likelihoods of a surface's points: all on it, or each on the nearest of the others.
/// Two standard errors less if a sample must do. O(surfaces)
double evidence_for(std::size_t k, const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud) {
  const std::vector<OrientedPoint> sample = cloud.some_of(surfaces[k].points, k_sample);
  if (sample.empty()) return 0;
  const double noise = surfaces[k].reach / k_deviations;
  std::vector<double> without(sample.size(), cost_of(k_deviations, 1));
  for (std::size_t other = 0; other < surfaces.size(); ++other) {
    if (other == k) continue;
    std::ranges::transform(without, costs_of(surfaces[other].surface, sample, noise), without.begin(),
                           [](double a, double b) { return std::min(a, b); });
  }
  const std::vector<double> with = costs_of(surfaces[k].surface, sample, noise);
  double sum = 0;
  double squares = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    sum += without[i] - with[i];
    squares += (without[i] - with[i]) * (without[i] - with[i]);
  }
  const auto count = static_cast<double>(sample.size());
  const auto all = static_cast<double>(surfaces[k].points.size());
  const double variance = std::max(0.0, squares / count - sum / count * sum / count);
  return all * (sum / count - 2 * std::sqrt(variance * (1 / count - 1 / all)));
}

/// Drops surfaces without evidence, the smallest first. @throws Cancelled
void drop_explained(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, const RunContext& run) {
  std::stable_sort(surfaces.begin(), surfaces.end(), [](const auto& a, const auto& b) {
    return preference(a.surface.type) * a.support > preference(b.surface.type) * b.support;
  });
  for (std::size_t k = surfaces.size(); k-- > 0;) {
    run.throw_if_stopped();
    if (evidence_for(k, surfaces, cloud) >= k_evidence) continue;
    surfaces.erase(surfaces.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

/// Gives each point to the nearest agreeing surface. Surfaces with fewer than `least` points are dropped.
void share_points(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, const AgreementLimits& limits,
                  std::size_t least, const RunContext& run) {
  const std::vector<std::vector<double>> distances = claim_all(surfaces, cloud, limits, run);
  std::vector<double> nearest(cloud.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> owner(cloud.size());
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    for (std::size_t n = 0; n < distances[k].size(); ++n) {
      const std::uint32_t i = surfaces[k].points[n];
      if (distances[k][n] >= nearest[i]) continue;
      nearest[i] = distances[k][n];
      owner[i] = k;
    }
  }
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    std::erase_if(surfaces[k].points, [&](std::uint32_t i) { return owner[i] != k; });
  }
  std::erase_if(surfaces, [&](const GrownSurface& s) { return s.points.size() < least; });
}

/// Whether so many points came or went since the last fit that a new one would move the surface noticeably. m of n
/// points at the limit of three deviations shift it by 3 m / n deviations, and its standard error is 1 / sqrt(n).
bool must_fit(const GrownSurface& s) {
  // At half or double of this, detection takes 2 % longer or shorter.
  constexpr double k_share_of_error = 0.35;
  std::vector<std::uint32_t> changed;
  std::ranges::set_symmetric_difference(s.points, s.fitted_to, std::back_inserter(changed));
  return static_cast<double>(changed.size()) >
         k_share_of_error / k_deviations * std::sqrt(static_cast<double>(s.points.size()));
}

/// @returns whether any surface was fitted to other points than before
bool fit_all(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, const AgreementLimits& limits,
             const RunContext& run) {
  std::vector<std::uint8_t> is_new(surfaces.size(), 0);
  for_each_index(surfaces.size(), run, [&](std::size_t k) {
    GrownSurface& s = surfaces[k];
    if (!must_fit(s)) return;
    is_new[k] = 1;
    s.fitted_to = s.points;
    const auto fitted = fit_plausible(s.surface, cloud, s.points, limits.within(s.reach));
    if (!fitted) return;
    s.surface = *fitted;
    s.reach = reach_of(s.surface, cloud, s.points, limits);
  });
  return std::ranges::find(is_new, 1) != is_new.end();
}

}  // namespace

std::vector<GrownSurface> settle_surfaces(std::vector<GrownSurface> surfaces, const WorkCloud& cloud,
                                          const SearchLimits& limits, const RunContext& run) {
  for (int round = 0; round < 2; ++round) {
    // A small surface also agrees with points on its far continuation. These would turn it onto its neighbour, so each
    // point counts for its nearest surface only.
    for (int again = 0; again < 5 && fit_all(surfaces, cloud, limits.agreement, run); ++again) {
      share_points(surfaces, cloud, limits.agreement, 0, run);
    }
    fit_all(surfaces, cloud, limits.agreement, run);
    claim_all(surfaces, cloud, limits.agreement, run);
    join_all(surfaces, cloud, limits.agreement, run);
    drop_explained(surfaces, cloud, run);
    share_points(surfaces, cloud, limits.agreement, limits.least_points, run);
    fit_all(surfaces, cloud, limits.agreement, run);
  }
  return surfaces;
}

}  // namespace cloud2csg
