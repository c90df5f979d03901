#include "raw/detect/settle_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "core/base/parallel.hpp"
#include "raw/detect/propose.hpp"
#include "raw/detect/share_points.hpp"
#include "raw/detect/unexplained.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

bool explains(const Surface& surface, const std::vector<OrientedPoint>& points, const AgreementLimits& limits,
              double share) {
  return static_cast<double>(count_agreeing(surface, points, limits)) >= share * static_cast<double>(points.size());
}

/// Sum of `more` - `less` over all points, from those of a sample, and two standard errors less.
double likely_sum(const std::vector<double>& more, const std::vector<double>& less, std::size_t points) {
  double sum = 0;
  double squares = 0;
  for (std::size_t i = 0; i < more.size(); ++i) {
    sum += more[i] - less[i];
    squares += (more[i] - less[i]) * (more[i] - less[i]);
  }
  const auto count = static_cast<double>(more.size());
  const auto all = static_cast<double>(points);
  const double variance = std::max(0.0, squares / count - sum / count * sum / count);
  return all * (sum / count - 2 * std::sqrt(variance * (1 / count - 1 / all)));
}

/// A connected group of points, or all groups together that are too small for a surface.
struct Piece {
  std::vector<OrientedPoint> sample;
  std::size_t points;  ///< number of all
};

std::vector<Piece> pieces_of(const std::vector<std::uint32_t>& points, const WorkCloud& cloud,
                             const SearchLimits& limits) {
  std::vector<Piece> pieces;
  std::vector<std::uint32_t> rest;
  for (const std::vector<std::uint32_t>& group : connected_groups(cloud.points, points, limits.link)) {
    if (group.size() < limits.least_points) {
      rest.insert(rest.end(), group.begin(), group.end());
    } else {
      pieces.push_back({cloud.some_of(group, k_sample), group.size()});
    }
  }
  if (!rest.empty()) pieces.push_back({cloud.some_of(rest, k_sample), rest.size()});
  return pieces;
}

/// Logarithm of the ratio of the likelihoods of the samples: each piece on the one of the two that explains it better,
/// or all on `one`. A piece counts as few points, so that form errors within the noise, such as those of a scan whose
/// views do not quite fit, are no evidence.
double evidence_for_two(const Surface& one, const GrownSurface& a, const GrownSurface& b,
                        const std::vector<Piece>& pieces, double noise) {
  // About two standard deviations between two radii are told apart; with double, one and a half.
  constexpr double k_counted = 128;
  double sum = 0;
  for (const Piece& piece : pieces) {
    const std::vector<double> together = costs_of(one, piece.sample, noise);
    const auto evidence = [&](const GrownSurface& own) {
      return likely_sum(together, costs_of(own.surface, piece.sample, noise), piece.sample.size());
    };
    const auto count = static_cast<double>(piece.sample.size());
    sum += std::min(1.0, k_counted / count) * std::max(evidence(a), evidence(b));
  }
  return sum;
}

/// One surface for the points of both, if it exists.
std::optional<GrownSurface> joined(const GrownSurface& a, const GrownSurface& b, const WorkCloud& cloud,
                                   const SearchLimits& search) {
  const AgreementLimits limits = search.agreement.within(std::max(a.reach, b.reach));
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
  GrownSurface both{.surface = *fitted, .points = {}, .reach = limits.distance};
  std::set_union(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), std::back_inserter(both.points));
  // Each face may be a surface of its own, with a radius that differs by less than its points do.
  const double evidence =
      evidence_for_two(*fitted, a, b, pieces_of(both.points, cloud, search), limits.distance / k_deviations);
  if (evidence >= least_evidence(a.surface.type, of_both.size())) return std::nullopt;
  return both;
}

/// @throws Cancelled
void join_all(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, const SearchLimits& limits,
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

/// Logarithm of the ratio of the likelihoods of a surface's points: all on it, or each on the nearest of the others.
/// Counts the pieces that speak for it: it may agree with other faces, too. O(surfaces)
double evidence_for(std::size_t k, const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                    const SearchLimits& limits) {
  const double noise = surfaces[k].reach / k_deviations;
  double most = 0;
  for (const Piece& piece : pieces_of(surfaces[k].points, cloud, limits)) {
    std::vector<double> without(piece.sample.size(), cost_of(k_deviations, 1));
    for (std::size_t other = 0; other < surfaces.size(); ++other) {
      if (other == k) continue;
      std::ranges::transform(without, costs_of(surfaces[other].surface, piece.sample, noise), without.begin(),
                             [](double a, double b) { return std::min(a, b); });
    }
    const std::vector<double> with = costs_of(surfaces[k].surface, piece.sample, noise);
    most = std::max(most, likely_sum(without, with, piece.points));
  }
  return most;
}

/// Drops surfaces without evidence, the smallest first. @throws Cancelled
void drop_explained(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, const SearchLimits& limits,
                    const RunContext& run) {
  for_each_index(surfaces.size(), run, [&](std::size_t k) {
    GrownSurface& s = surfaces[k];
    s.support = support_by(s.points, s.surface, cloud, limits.agreement.within(s.reach));
  });
  std::stable_sort(surfaces.begin(), surfaces.end(), [](const auto& a, const auto& b) {
    return preference(a.surface.type) * a.support > preference(b.surface.type) * b.support;
  });
  for (std::size_t k = surfaces.size(); k-- > 0;) {
    run.throw_if_stopped();
    const double least = least_evidence(surfaces[k].surface.type, surfaces[k].points.size());
    if (evidence_for(k, surfaces, cloud, limits) >= least) continue;
    surfaces.erase(surfaces.begin() + static_cast<std::ptrdiff_t>(k));
  }
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

std::vector<GrownSurface> settle_surfaces(std::vector<GrownSurface> surfaces, WorkCloud& cloud,
                                          const NeighbourTable& neighbours, const SearchLimits& limits,
                                          const RunContext& run) {
  std::vector<OwnNormal> own_normals;
  for (int round = 0; round < 2; ++round) {
    if (round > 0) own_normals = turn_normals(cloud, surfaces, neighbours);
    // A small surface also agrees with points on its far continuation. These would turn it onto its neighbour, so each
    // point counts for one surface only.
    for (int again = 0; again < 5 && fit_all(surfaces, cloud, limits.agreement, run); ++again) {
      surfaces = share_points(std::move(surfaces), cloud, neighbours, limits.agreement, 0, run);
    }
    fit_all(surfaces, cloud, limits.agreement, run);
    claim_all(surfaces, cloud, limits.agreement, run);
    join_all(surfaces, cloud, limits, run);
    drop_explained(surfaces, cloud, limits, run);
    surfaces = share_points(std::move(surfaces), cloud, neighbours, limits.agreement, limits.least_points, run);
    fit_all(surfaces, cloud, limits.agreement, run);
  }
  turn_back(cloud, own_normals, surfaces);
  return surfaces;
}

}  // namespace cloud2csg
