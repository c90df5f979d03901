#include "raw/detect/split_surfaces.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "raw/detect/propose.hpp"
#include "raw/prepare/constants.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// Mean of the successive distances whose mean is least likely by chance, of windows of all powers of two. 0 if none
/// is off by 3.7 standard errors: this is a cheap first look, and most surfaces end here.
double strongest_offset(const std::vector<double>& distances, double noise) {
  const double most = 10 * noise;  // a single outlier is no step
  std::vector<double> sums{0};
  for (const double d : distances) sums.push_back(sums.back() + std::clamp(d, -most, most));
  double best = k_evidence * noise * noise;
  std::span<const double> strongest;
  for (std::size_t width = 2 * k_nearest; width <= distances.size(); width *= 2) {
    for (std::size_t first = 0; first + width <= distances.size(); first += width / 2) {
      const double sum = sums[first + width] - sums[first];
      if (sum * sum / static_cast<double>(width) <= best) continue;
      best = sum * sum / static_cast<double>(width);
      strongest = std::span(distances).subspan(first, width);
    }
  }
  const double sum = std::accumulate(strongest.begin(), strongest.end(), 0.0);
  return strongest.empty() ? 0 : sum / static_cast<double>(strongest.size());
}

/// The least cost of points whose distances are a quadratic function of their places, found by iterated trimming.
double smooth_cost(std::span<const double> distances, std::span<const Vector3d> places, double noise) {
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
      const Terms terms = terms_at(places[k]);
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

/// Points near one surface, on which a step is looked for.
struct NearPoints {
  const WorkCloud& cloud;
  std::vector<std::uint32_t> points;  ///< ascending
  std::vector<double> distances;      ///< from the one surface
  NeighbourTable neighbours;          ///< among these points
  double noise;
  double offset;  ///< about the height of the step
  AgreementLimits fit_limits;

  /// Two surfaces are found by these, and tested by the others.
  static bool is_for_fit(std::size_t k) { return k % 2 == 0; }
};

/// Two surfaces, and the one on which each point is.
struct TwoSurfaces {
  std::array<Surface, 2> surfaces;
  std::array<std::vector<double>, 2> distances;  ///< of all points from each
  std::vector<std::uint8_t> side;                ///< of each point: 0 or 1

  [[nodiscard]] double distance(std::size_t k) const { return distances[side[k]][k]; }
};

double share_on_own_side(const TwoSurfaces& two, const NearPoints& near, std::size_t k) {
  const std::span<const std::uint32_t> around = near.neighbours.of(k);
  const auto same = std::ranges::count_if(around, [&](std::uint32_t j) { return two.side[j] == two.side[k]; });
  return static_cast<double>(same) / static_cast<double>(around.size());
}

/// Puts each point on the side that its neighbours are likelier to be on. `prior`: how much likelier side 0 is.
void choose_sides(TwoSurfaces& two, const NearPoints& near, double prior) {
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    double for_second = -prior;
    for (const std::uint32_t j : near.neighbours.of(k)) {
      if (!NearPoints::is_for_fit(j)) continue;
      for_second += cost_of(two.distances[0][j], near.noise) - cost_of(two.distances[1][j], near.noise);
    }
    two.side[k] = for_second > 0 ? 1 : 0;
  }
}

/// Points of each side that are clear of the other, of those with `is_used(k)`.
template <typename IsUsed>
std::array<std::vector<std::uint32_t>, 2> clear_points(const TwoSurfaces& two, const NearPoints& near,
                                                       const IsUsed& is_used) {
  std::array<std::vector<std::uint32_t>, 2> clear;
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    if (is_used(k) && share_on_own_side(two, near, k) >= k_clear_share) clear[two.side[k]].push_back(near.points[k]);
  }
  return clear;
}

/// Fits each surface to its points. @returns whether both fits exist
bool refit(TwoSurfaces& two, const std::array<std::vector<std::uint32_t>, 2>& points, const NearPoints& near) {
  for (std::size_t side = 0; side < 2; ++side) {
    const auto fitted = fit_plausible(two.surfaces[side], near.cloud, points[side], near.fit_limits);
    if (!fitted) return false;
    two.surfaces[side] = *fitted;
    two.distances[side] = distances_of(*fitted, near.cloud, near.points);
  }
  return true;
}

/// Alternates between choosing sides and fitting (classification EM: Celeux and Govaert 1992).
std::optional<TwoSurfaces> fit_two(const Surface& one, const NearPoints& near) {
  TwoSurfaces two{.surfaces = {one, one},
                  .distances = {near.distances, near.distances},
                  .side = std::vector<std::uint8_t>(near.points.size(), 0)};
  for (double& d : two.distances[1]) d -= near.offset;
  double prior = 0;
  std::vector<std::uint8_t> before;
  for (int round = 0; round < 2 * k_rounds && two.side != before; ++round) {
    before = two.side;
    choose_sides(two, near, prior);
    const auto clear = clear_points(two, near, NearPoints::is_for_fit);
    if (clear[0].empty() || clear[1].empty() || !refit(two, clear, near)) return std::nullopt;
    prior = std::log(static_cast<double>(clear[0].size()) / static_cast<double>(clear[1].size()));
  }
  return two;
}

/// Logarithm of the ratio of likelihoods of two surfaces and one.
double gain_of(const TwoSurfaces& two, const Surface& one, const NearPoints& near) {
  std::vector<double> distances;
  std::vector<Vector3d> places;
  double cost = 0;
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    if (NearPoints::is_for_fit(k)) continue;
    const Vector3d& position = near.cloud.points[near.points[k]].position;
    distances.push_back(near.distances[k]);
    places.emplace_back(position - near.distances[k] * normal(one, position));
    cost += cost_of(two.distance(k), near.noise);
  }
  return smooth_cost(distances, places, near.noise) - cost;
}

std::uint8_t smaller_side(const TwoSurfaces& two) {
  return 2 * std::ranges::count(two.side, std::uint8_t{1}) <= std::ssize(two.side) ? 1 : 0;
}

/// Whether the surface of the smaller side explains the points away from the step as well as averages do, which adapt
/// to form errors. The average of 8 points with noise is an eighth of the variance worse than the true surface. False
/// if these points are fewer than a surface needs.
bool matches_averages(const TwoSurfaces& two, const NearPoints& near, std::size_t least_points) {
  const std::uint8_t smaller = smaller_side(two);
  double excess = 0;
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    if (two.side[k] != smaller || share_on_own_side(two, near, k) < 1) continue;
    double sum = 0;
    for (const std::uint32_t j : near.neighbours.of(k).first(k_nearest)) sum += near.distances[j];
    const double more = cost_of(two.distance(k), near.noise) - cost_of(near.distances[k] - sum / k_nearest, near.noise);
    excess += more;
    squares += more * more;
    ++count;
  }
  return count >= least_points && excess <= std::sqrt(squares);
}

/// Whether the surfaces are apart where their points meet, too. Else they cross there: a slight bend is no step.
bool are_apart(const TwoSurfaces& two, const NearPoints& near) {
  const std::uint8_t smaller = smaller_side(two);
  std::array<double, 2> gaps{};  // of points near the other side, and of clear ones
  std::array<std::size_t, 2> counts{};
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    const std::size_t is_clear = share_on_own_side(two, near, k) >= k_clear_share ? 1 : 0;
    if (is_clear == 1 && two.side[k] != smaller) continue;
    gaps[is_clear] += std::abs(two.distances[0][k] - two.distances[1][k]);
    ++counts[is_clear];
  }
  if (counts[0] == 0 || counts[1] == 0) return true;
  return gaps[0] / static_cast<double>(counts[0]) >= k_clear_share * gaps[1] / static_cast<double>(counts[1]);
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
                                                 const SearchLimits& limits) {
  std::optional<TwoSurfaces> two = fit_two(grown.surface, near);
  if (!two || !(gain_of(*two, grown.surface, near) >= k_evidence)) return std::nullopt;
  if (!refit(*two, clear_points(*two, near, [](std::size_t) { return true; }), near)) return std::nullopt;
  if (!matches_averages(*two, near, limits.least_points) || !are_apart(*two, near)) return std::nullopt;
  std::array<GrownSurface, 2> parts = parts_of(*two, near, limits.agreement);
  if (std::ranges::any_of(parts, [&](const auto& part) { return part.points.size() < limits.least_points; })) {
    return std::nullopt;
  }
  return parts;
}

/// Absent if no run of neighbouring points is off the surface.
std::optional<NearPoints> near_points(const GrownSurface& grown, const WorkCloud& cloud,
                                      const std::vector<bool>& is_free, const SearchLimits& limits,
                                      const RunContext& run) {
  AgreementLimits wide = limits.agreement;
  wide.distance *= 3;  // a step within could hide in the limits
  std::vector<std::uint32_t> points = points_near(grown, cloud, wide, [&](std::uint32_t i) { return is_free[i]; });
  if (points.size() < 2 * limits.least_points || points.size() <= k_around) return std::nullopt;
  const double least = limits.agreement.noise;
  const double noise =
      std::max(least, noise_within_patches(distances_of(grown.surface, cloud, grown.points)).value_or(least));
  std::vector<double> distances = distances_of(grown.surface, cloud, points);
  const double offset = strongest_offset(distances, noise);
  if (offset == 0) return std::nullopt;
  const Points positions = cloud.positions_of(points);
  return NearPoints{.cloud = cloud,
                    .points = std::move(points),
                    .distances = std::move(distances),
                    .neighbours = find_neighbours(positions, NeighbourTree(positions), k_around, run),
                    .noise = noise,
                    .offset = offset,
                    .fit_limits = limits.agreement.within(std::min(k_deviations * noise, limits.agreement.distance))};
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
    auto parts = near ? split(surfaces[s], *near, limits) : std::nullopt;
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
