#include "raw/detect/recombine_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/robust_deviation.hpp"
#include "core/geometry/subset.hpp"
#include "raw/detect/propose.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

/// Variance of the means of patches of the surface's points over that of independent errors: 1 for the right surface,
/// more if neighbours share errors. By the median patch, as a few are off at edges. 0 without a patch.
double variance_of_patches(const GrownSurface& grown, const WorkCloud& cloud, double least_noise) {
  const std::vector<double> distances = distances_of(grown.surface, cloud, grown.points);
  std::vector<double> means;
  for (std::size_t first = 0; first + k_patch <= distances.size(); first += k_patch) {
    double sum = 0;
    for (std::size_t k = first; k < first + k_patch; ++k) sum += distances[k];
    means.push_back(std::abs(sum) / k_patch);
  }
  if (means.empty()) return 0;
  const double noise = std::max(noise_within_patches(distances).value_or(0), least_noise);
  return k_patch * std::pow(robust_deviation(means) / noise, 2);
}

/// What patches of their points tell of surfaces.
struct PatchErrors {
  std::vector<bool> is_exact;   ///< by surface: no point is farther off than the noise allows. Points of facets are
  std::vector<bool> is_off;     ///< by surface: exact and round, but wrong as far as its points tell
  double points_per_error = 1;  ///< as many neighbours share one error
};

/// One of so many points is on a right surface. With a quarter instead of a tenth, one more turned part in sixty keeps
/// wrong ones (`bench_profiles --noise 0.001`).
constexpr std::size_t k_best_part = 10;

/// Surfaces are off if their patches vary clearly more than those of the best tenth of the points. Planes may be those
/// of a low step: see split_surfaces().
PatchErrors patch_errors(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, double noise,
                         const RunContext& run) {
  std::vector<double> variances(surfaces.size());
  for_each_index(surfaces.size(), run,
                 [&](std::size_t s) { variances[s] = variance_of_patches(surfaces[s], cloud, noise); });
  PatchErrors errors;
  std::vector<double> by_patch;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    errors.is_exact.push_back(k_clear_share * surfaces[s].reach <= k_deviations * noise);
    if (errors.is_exact[s]) by_patch.insert(by_patch.end(), surfaces[s].points.size() / k_patch, variances[s]);
  }
  if (!by_patch.empty()) {
    const auto best = by_patch.begin() + static_cast<std::ptrdiff_t>(by_patch.size() / k_best_part);
    std::ranges::nth_element(by_patch, best);
    errors.points_per_error = std::max(errors.points_per_error, *best);
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const bool is_round = surfaces[s].surface.type != SurfaceType::plane;
    errors.is_off.push_back(errors.is_exact[s] && is_round && k_clear_share * variances[s] > errors.points_per_error);
  }
  return errors;
}

/// Numbers of one surface, or of two that touch.
using SurfaceGroup = std::vector<std::size_t>;

/// Each surface that is off, alone and with each exact one that it touches.
std::vector<SurfaceGroup> doubtful_groups(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                          const NeighbourTable& neighbours, const PatchErrors& errors) {
  const std::vector<std::size_t> surface_of = owners_of_points(surfaces, cloud);
  std::vector<SurfaceGroup> groups;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (!errors.is_off[s]) continue;
    groups.push_back({s});
    std::vector<std::size_t> contacts(surfaces.size() + 1, 0);
    for (const std::uint32_t i : surfaces[s].points) {
      for (const std::uint32_t j : neighbours.of(i)) ++contacts[surface_of[j]];
    }
    for (std::size_t other = 0; other < surfaces.size(); ++other) {
      const bool is_known = other == s || (other < s && errors.is_off[other]);
      if (contacts[other] >= k_nearest && errors.is_exact[other] && !is_known) groups.push_back({s, other});
    }
  }
  return groups;
}

/// Surfaces of all types, as far as they fit the points.
std::vector<Surface> estimates(std::span<const OrientedPoint> points, const AgreementLimits& limits) {
  std::vector<Surface> result;
  for (const SurfaceType type :
       {SurfaceType::plane, SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::cone, SurfaceType::torus}) {
    if (const std::optional<Surface> surface = estimate_plausible(type, points, limits)) result.push_back(*surface);
  }
  return result;
}

/// A surface in place of a group, or of one of its two.
struct Replacement {
  SurfaceGroup group;
  Surface surface;
  std::optional<std::size_t> stays;  ///< of the group
  double gain;
};

/// Compares surfaces of a group by points of it: those of each surface in turn, one for each independent error, and at
/// most k_large_sample. With half as many, fewer wrong surfaces are told from right ones; double takes longer.
class Contest {
 public:
  Contest(SurfaceGroup group, const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
          const AgreementLimits& limits, double points_per_error)
      : group_(std::move(group)), limits_(limits) {
    limits_.distance = 0;
    for (const std::size_t s : group_) limits_.distance = std::max(limits_.distance, surfaces[s].reach);
    for (const std::size_t s : group_) {
      const double errors = std::ceil(static_cast<double>(surfaces[s].points.size()) / points_per_error);
      const std::vector<OrientedPoint> some =
          cloud.some_of(surfaces[s].points, std::min(static_cast<std::size_t>(errors), k_large_sample));
      for (const double cost : costs_on(surfaces[s].surface, some)) cost_now_ += cost;
      points_.insert(points_.end(), some.begin(), some.end());
      ends_.push_back(points_.size());
    }
    for (const std::size_t s : group_) {
      costs_.push_back(costs_on(surfaces[s].surface, points_));
      prices_.push_back(price_of(surfaces[s].surface));
      cost_now_ += prices_.back();
    }
  }

  /// Tries the surfaces known for each of the group, and those that fit the points of both. Absent if none is better
  /// beyond doubt, or if few points tell. One in place of two needs to be only as likely.
  [[nodiscard]] std::optional<Replacement> best_replacement(const std::vector<std::vector<Surface>>& known) const {
    if (points_.size() < 2 * k_patch) return std::nullopt;
    std::optional<Replacement> best;
    const auto consider = [&](const Surface& surface) {
      Replacement other = replacement_by(surface);
      if (!best || other.gain > best->gain) best = std::move(other);
    };
    for (const std::size_t s : group_) std::ranges::for_each(known[s], consider);
    if (group_.size() > 1) {
      std::ranges::for_each(estimates(some_of(std::span(points_), k_sample), limits_), consider);
    }
    if (!best) return std::nullopt;
    if (const std::optional<Surface> fitted = fit_plausible(best->surface, points_, limits_)) consider(*fitted);
    return best->gain > k_evidence ? best : std::nullopt;
  }

 private:
  [[nodiscard]] double price_of(const Surface& surface) const { return least_evidence(surface.type, points_.size()); }
  [[nodiscard]] std::vector<double> costs_on(const Surface& surface, std::span<const OrientedPoint> points) const {
    return costs_of(surface, points, limits_.distance / k_deviations);
  }

  /// The best: in place of all, or beside one that stays.
  [[nodiscard]] Replacement replacement_by(const Surface& surface) const {
    const std::vector<double> costs = costs_on(surface, points_);
    const double alone = std::accumulate(costs.begin(), costs.end(), price_of(surface));
    Replacement best{.group = group_, .surface = surface, .stays = std::nullopt, .gain = cost_now_ - alone};
    if (group_.size() == 1) return best;
    for (std::size_t k = 0; k < group_.size(); ++k) {
      const double both = price_of(surface) + prices_[k] + cost_on_either(costs, costs_[k]);
      if (cost_now_ - both > best.gain) {
        best.stays = group_[k];
        best.gain = cost_now_ - both;
      }
    }
    return best;
  }

  /// A patch of points is on one of the two. If each point were on the nearer one, two surfaces in one place would have
  /// less noise than one.
  [[nodiscard]] double cost_on_either(std::span<const double> a, std::span<const double> b) const {
    double sum = 0;
    std::size_t first = 0;
    for (const std::size_t end : ends_) {
      for (std::size_t last = first; first < end; first = last) {
        last = std::min(first + k_patch, end);
        const auto cost = [&](std::span<const double> costs) {
          return std::accumulate(costs.begin() + static_cast<std::ptrdiff_t>(first),
                                 costs.begin() + static_cast<std::ptrdiff_t>(last), 0.0);
        };
        sum += std::min(cost(a), cost(b));
      }
    }
    return sum;
  }

  SurfaceGroup group_;
  AgreementLimits limits_;
  std::vector<OrientedPoint> points_;
  std::vector<std::size_t> ends_;           // of the points of each surface
  std::vector<std::vector<double>> costs_;  // by surface, then point
  std::vector<double> prices_;              // by surface
  double cost_now_ = 0;                     // of the points on their surfaces, with the prices
};

/// The new surface takes the points of replaced ones that are within the largest reach of the group; the others become
/// free. Of the one that stays, it takes those that are nearer to it.
GrownSurface put_in_place(const Replacement& replacement, std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                          const AgreementLimits& limits) {
  GrownSurface added{.surface = replacement.surface, .points = {}};
  for (const std::size_t s : replacement.group) added.reach = std::max(added.reach, surfaces[s].reach);
  for (const std::size_t s : replacement.group) {
    GrownSurface& before = surfaces[s];
    const std::vector<double> to_new = distances_of(added.surface, cloud, before.points);
    const std::vector<double> to_own = distances_of(before.surface, cloud, before.points);
    std::vector<std::uint32_t> left;
    for (std::size_t k = 0; k < to_new.size(); ++k) {
      const double most = replacement.stays == s ? std::min(added.reach, std::abs(to_own[k])) : added.reach;
      (std::abs(to_new[k]) <= most ? added.points : left).push_back(before.points[k]);
    }
    before.points = std::move(left);
    if (replacement.stays != s) before.points.clear();
  }
  std::ranges::sort(added.points);
  added.reach = reach_of(added.surface, cloud, added.points, limits);
  return added;
}

/// The best replacement of each group that has one. @throws Cancelled
std::vector<Replacement> best_replacements(const std::vector<SurfaceGroup>& groups,
                                           const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                           const AgreementLimits& limits, double points_per_error,
                                           const RunContext& run) {
  std::vector<bool> is_asked(surfaces.size(), false);
  for (const SurfaceGroup& group : groups) {
    for (const std::size_t s : group) is_asked[s] = true;
  }
  std::vector<std::vector<Surface>> known(surfaces.size());  // that fit the points of one surface
  for_each_index(surfaces.size(), run, [&](std::size_t s) {
    if (!is_asked[s]) return;
    known[s] = estimates(cloud.some_of(surfaces[s].points, k_sample), limits.within(surfaces[s].reach));
  });
  std::vector<std::optional<Replacement>> found(groups.size());
  for_each_index(groups.size(), run, [&](std::size_t g) {
    found[g] = Contest(groups[g], surfaces, cloud, limits, points_per_error).best_replacement(known);
  });
  std::vector<Replacement> replacements;
  for (std::optional<Replacement>& replacement : found) {
    if (replacement) replacements.push_back(std::move(*replacement));
  }
  return replacements;
}

}  // namespace

std::optional<std::vector<GrownSurface>> recombined(std::vector<GrownSurface> surfaces, const WorkCloud& cloud,
                                                    const NeighbourTable& neighbours, const SearchLimits& limits,
                                                    const RunContext& run) {
  const PatchErrors errors = patch_errors(surfaces, cloud, limits.agreement.noise, run);
  if (std::ranges::find(errors.is_off, true) == errors.is_off.end()) return std::nullopt;
  const std::vector<SurfaceGroup> groups = doubtful_groups(surfaces, cloud, neighbours, errors);
  std::vector<Replacement> found =
      best_replacements(groups, surfaces, cloud, limits.agreement, errors.points_per_error, run);
  if (found.empty()) return std::nullopt;
  std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.gain > b.gain; });
  std::vector<bool> is_replaced(surfaces.size(), false);
  for (const Replacement& replacement : found) {
    if (std::ranges::any_of(replacement.group, [&](std::size_t s) { return is_replaced[s]; })) continue;
    for (const std::size_t s : replacement.group) is_replaced[s] = true;
    surfaces.push_back(put_in_place(replacement, surfaces, cloud, limits.agreement));
  }
  std::erase_if(surfaces, [](const GrownSurface& s) { return s.points.empty(); });
  return surfaces;
}

}  // namespace cloud2csg
