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

/// What is known of surfaces beside their fits.
struct Doubts {
  std::vector<bool> is_exact;  ///< by surface: no point is farther off than the noise allows. Points of facets are
  std::vector<bool> is_off;    ///< by surface: exact, round, and wrong as far as its points tell
  double shared = 1;           ///< as many neighbours have one independent error
};

/// One of so many points is on a right surface. With a quarter instead of a tenth, one more turned part in sixty keeps
/// wrong ones (`bench_profiles --noise 0.001`).
constexpr std::size_t k_best_part = 10;

/// Surfaces are off if their patches vary clearly more than those of the best tenth of the points. Planes may be those
/// of a low step: see split_surfaces().
Doubts doubts_about(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, double noise,
                    const RunContext& run) {
  std::vector<double> variances(surfaces.size());
  for_each_index(surfaces.size(), run,
                 [&](std::size_t s) { variances[s] = variance_of_patches(surfaces[s], cloud, noise); });
  std::vector<double> by_patch;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    by_patch.insert(by_patch.end(), surfaces[s].points.size() / k_patch, variances[s]);
  }
  Doubts doubts;
  if (!by_patch.empty()) {
    const auto best = by_patch.begin() + static_cast<std::ptrdiff_t>(by_patch.size() / k_best_part);
    std::ranges::nth_element(by_patch, best);
    doubts.shared = std::max(doubts.shared, *best);
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const bool is_round = surfaces[s].surface.type != SurfaceType::plane;
    doubts.is_exact.push_back(k_clear_share * surfaces[s].reach <= k_deviations * noise);
    doubts.is_off.push_back(doubts.is_exact[s] && is_round && k_clear_share * variances[s] > doubts.shared);
  }
  return doubts;
}

/// Numbers of one surface, or of two that touch.
using SurfaceGroup = std::vector<std::size_t>;

/// Each surface that is off, alone and with each exact one that it touches.
std::vector<SurfaceGroup> doubtful_groups(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                          const NeighbourTable& neighbours, const Doubts& doubts) {
  std::vector<std::size_t> surface_of(cloud.size(), surfaces.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    for (const std::uint32_t i : surfaces[s].points) surface_of[i] = s;
  }
  std::vector<SurfaceGroup> groups;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (doubts.is_off[s]) groups.push_back({s});
    std::vector<std::size_t> contacts(surfaces.size() + 1, 0);
    for (const std::uint32_t i : surfaces[s].points) {
      for (const std::uint32_t j : neighbours.of(i)) ++contacts[surface_of[j]];
    }
    for (std::size_t other = s + 1; other < surfaces.size(); ++other) {
      const bool are_doubtful =
          (doubts.is_off[s] && doubts.is_exact[other]) || (doubts.is_off[other] && doubts.is_exact[s]);
      if (are_doubtful && contacts[other] >= k_nearest) groups.push_back({s, other});
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

/// Points of a group, those of each surface in turn, and their costs on each surface. One of `shared` points counts,
/// and at most k_large_sample of a surface: with half as many, fewer wrong surfaces are told from right ones; double
/// takes longer.
class Contest {
 public:
  Contest(SurfaceGroup group, const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
          const AgreementLimits& limits, double shared)
      : group_(std::move(group)), limits_(limits) {
    limits_.distance = 0;
    for (const std::size_t s : group_) limits_.distance = std::max(limits_.distance, surfaces[s].reach);
    for (const std::size_t s : group_) {
      const std::size_t most = std::min(surfaces[s].points.size(), k_large_sample);
      const auto counted = static_cast<std::size_t>(std::ceil(static_cast<double>(most) / shared));
      const std::vector<OrientedPoint> some = cloud.some_of(surfaces[s].points, counted);
      for (const double cost : costs_on(surfaces[s].surface, some)) now_ += cost;
      points_.insert(points_.end(), some.begin(), some.end());
    }
    for (const std::size_t s : group_) {
      costs_.push_back(costs_on(surfaces[s].surface, points_));
      prices_.push_back(price_of(surfaces[s].surface));
      now_ += prices_.back();
    }
  }

  /// Tries the surfaces known for each of the group, and those that fit the points of both.
  [[nodiscard]] std::optional<Replacement> best_replacement(const std::vector<std::vector<Surface>>& known) const {
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
    Replacement best{.group = group_, .surface = surface, .stays = std::nullopt, .gain = now_ - alone};
    if (group_.size() == 1) return best;
    for (std::size_t k = 0; k < group_.size(); ++k) {
      const double both = price_of(surface) + prices_[k] + cost_on_either(costs, costs_[k]);
      if (now_ - both > best.gain) {
        best.stays = group_[k];
        best.gain = now_ - both;
      }
    }
    return best;
  }

  /// A patch of points is on one of the two. If each point were on the nearer one, two surfaces in one place would have
  /// less noise than one.
  static double cost_on_either(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t first = 0; first < a.size(); first += k_patch) {
      const std::size_t count = std::min(k_patch, a.size() - first);
      const auto cost = [&](std::span<const double> costs) {
        const auto some = costs.subspan(first, count);
        return std::accumulate(some.begin(), some.end(), 0.0);
      };
      sum += std::min(cost(a), cost(b));
    }
    return sum;
  }

  SurfaceGroup group_;
  AgreementLimits limits_;
  std::vector<OrientedPoint> points_;
  std::vector<std::vector<double>> costs_;  // by surface, then point
  std::vector<double> prices_;              // by surface
  double now_ = 0;                          // of the points on their surfaces, with the prices
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
                                           const AgreementLimits& limits, double shared, const RunContext& run) {
  std::vector<std::vector<Surface>> known(surfaces.size());  // that fit the points of one surface
  for_each_index(surfaces.size(), run, [&](std::size_t s) {
    const bool is_asked =
        std::ranges::any_of(groups, [&](const SurfaceGroup& g) { return std::ranges::count(g, s) > 0; });
    if (!is_asked) return;
    known[s] = estimates(cloud.some_of(surfaces[s].points, k_sample), limits.within(surfaces[s].reach));
  });
  std::vector<std::optional<Replacement>> found(groups.size());
  for_each_index(groups.size(), run, [&](std::size_t g) {
    found[g] = Contest(groups[g], surfaces, cloud, limits, shared).best_replacement(known);
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
  const Doubts doubts = doubts_about(surfaces, cloud, limits.agreement.noise, run);
  const std::vector<SurfaceGroup> groups = doubtful_groups(surfaces, cloud, neighbours, doubts);
  std::vector<Replacement> found = best_replacements(groups, surfaces, cloud, limits.agreement, doubts.shared, run);
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
