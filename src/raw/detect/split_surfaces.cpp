#include "raw/detect/split_surfaces.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "raw/detect/two_surfaces.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// The least cost of points whose distances are a quadratic function of their places, found by iterated trimming. The
/// distances are given times the precisions.
double smooth_cost(std::span<const double> distances, std::span<const double> precisions,
                   std::span<const Vector3d> places, double noise) {
  using Terms = Eigen::Matrix<double, 10, 1>;
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : places) middle += p / static_cast<double>(places.size());
  double size = 0;
  for (const Vector3d& p : places) size = std::max(size, (p - middle).norm());
  const auto terms_at = [&](const Vector3d& place) {
    const Vector3d p = (place - middle) / size;
    Terms terms;
    terms << 1, p, p.cwiseProduct(p), p.x() * p.y(), p.y() * p.z(), p.z() * p.x();
    return terms;
  };
  Terms factors = Terms::Zero();
  double least = 0;
  for (int trim = 0; trim <= k_rounds; ++trim) {
    Eigen::Matrix<double, 10, 10> squares = Eigen::Matrix<double, 10, 10>::Zero();
    Terms products = Terms::Zero();
    double cost = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Terms terms = precisions[k] * terms_at(places[k]);
      const double rest = distances[k] - terms.dot(factors);
      cost += cost_of(rest, noise);
      if (trim > 0 && std::abs(rest) > k_deviations * noise) continue;
      squares.selfadjointView<Eigen::Lower>().rankUpdate(terms);
      products += distances[k] * terms;
    }
    least = trim == 0 ? cost : std::min(least, cost);
    if (trim == k_rounds) break;
    // On a plane or sphere, the terms depend on each other.
    constexpr double k_ridge = 1e-9;
    squares.diagonal().array() += k_ridge * static_cast<double>(places.size());
    factors = squares.selfadjointView<Eigen::Lower>().ldlt().solve(products);
  }
  return least;
}

/// How far a point is off the average of its neighbours.
double off_average(const NearPoints& near, std::size_t k) {
  double sum = 0;
  for (const std::uint32_t j : near.neighbours.of(k).first(k_nearest)) sum += near.distances[j];
  return near.distances[k] - sum / k_nearest;
}

/// Logarithm of the ratio of the likelihoods of two surfaces, and of one with a smooth form error. If averages explain
/// the points better than the two, neighbours share errors, and as much of the ratio is owed to these.
double gain_of(const TwoSurfaces& two, const NearPoints& near) {
  std::vector<double> precisions;
  std::vector<Vector3d> places;
  double of_averages = 0;
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    precisions.push_back(near.cloud.points[near.points[k]].precision);
    places.push_back(near.feet[k]);
    of_averages += cost_of(off_average(near, k), near.noise);
  }
  const double of_two = cost_of(two, near);
  const double gain = smooth_cost(near.distances, precisions, places, near.noise) - of_two;
  return gain - std::max(0.0, of_two - of_averages);
}

/// Whether the surface of the smaller side explains the points away from the step as well as averages do, which adapt
/// to form errors. The average of 8 points with noise is an eighth of the variance worse than the true surface. False
/// if these points are fewer than a surface needs.
bool matches_averages(const TwoSurfaces& two, const NearPoints& near, std::size_t least_points) {
  double excess = 0;
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    if (two.side[k] == 0 || share_on_own_side(two, near, k) < 1) continue;
    const double more = cost_of(two.distance(k), near.noise) - cost_of(off_average(near, k), near.noise);
    excess += more;
    squares += more * more;
    ++count;
  }
  return count >= least_points && excess <= std::sqrt(squares);
}

/// Whether the surfaces are as far apart where their points meet. Else they cross there: a slight bend is no step.
bool are_apart(const TwoSurfaces& two, const NearPoints& near) {
  std::array<double, 2> gaps{};  // of points near the other side, and of clear ones
  std::array<std::size_t, 2> counts{};
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    const std::size_t is_clear = share_on_own_side(two, near, k) >= k_clear_share ? 1 : 0;
    if (is_clear == 1 && two.side[k] == 0) continue;
    const double precision = near.cloud.points[near.points[k]].precision;
    gaps[is_clear] += (two.distances[0][k] - two.distances[1][k]) / precision;
    ++counts[is_clear];
  }
  if (counts[0] == 0 || counts[1] == 0) return true;
  const double across = gaps[1] / static_cast<double>(counts[1]);
  return gaps[0] / static_cast<double>(counts[0]) / across >= k_clear_share;
}

/// The surfaces with the points within their reach. A point beyond that of its own side may be on the other.
std::array<GrownSurface, 2> parts_of(const TwoSurfaces& two, const NearPoints& near, const AgreementLimits& limits) {
  std::array<std::vector<std::uint32_t>, 2> points;
  for (std::size_t k = 0; k < near.points.size(); ++k) points[two.side[k]].push_back(near.points[k]);
  std::array<GrownSurface, 2> parts;
  for (std::size_t side = 0; side < 2; ++side) {
    const Surface& surface = two.surfaces[side];
    parts[side] = {.surface = surface, .points = {}, .reach = reach_of(surface, near.cloud, points[side], limits)};
  }
  const auto is_within = [&](std::size_t side, std::size_t k) {
    return std::abs(two.distances[side][k]) <= parts[side].reach;
  };
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    const std::size_t own = two.side[k];
    const std::size_t side = is_within(own, k) ? own : 1 - own;
    if (is_within(side, k)) parts[side].points.push_back(near.points[k]);
  }
  return parts;
}

/// The two parts, if there is a step.
std::optional<std::array<GrownSurface, 2>> split(const GrownSurface& grown, const NearPoints& near,
                                                 const SearchLimits& limits, const RunContext& run) {
  const std::optional<TwoSurfaces> two = fit_two(grown.surface, near, run);
  if (!two || !(gain_of(*two, near) >= least_evidence(grown.surface.type, near.points.size()))) return std::nullopt;
  if (!matches_averages(*two, near, limits.least_points) || !are_apart(*two, near)) return std::nullopt;
  std::array<GrownSurface, 2> parts = parts_of(*two, near, limits.agreement);
  if (std::ranges::any_of(parts, [&](const auto& part) { return part.points.size() < limits.least_points; })) {
    return std::nullopt;
  }
  return parts;
}

}  // namespace

std::vector<GrownSurface> split_surfaces(std::vector<GrownSurface> surfaces, const WorkCloud& cloud,
                                         const SearchLimits& limits, const RunContext& run) {
  std::vector<bool> is_free(cloud.size(), true);
  const auto set_free = [&](const GrownSurface& surface, bool free) {
    for (const std::uint32_t i : surface.points) is_free[i] = free;
  };
  for (const GrownSurface& surface : surfaces) set_free(surface, false);
  for (std::size_t s = 0; s < surfaces.size();) {
    run.throw_if_stopped();
    const std::optional<NearPoints> near = near_points(surfaces[s], cloud, is_free, limits, run);
    auto parts = near ? split(surfaces[s], *near, limits, run) : std::nullopt;
    if (!parts) {
      ++s;
      continue;
    }
    set_free(surfaces[s], true);
    for (const GrownSurface& part : *parts) set_free(part, false);
    surfaces[s] = std::move((*parts)[0]);
    surfaces.push_back(std::move((*parts)[1]));
  }
  return surfaces;
}

}  // namespace cloud2csg
