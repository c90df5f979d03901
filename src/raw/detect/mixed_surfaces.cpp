#include "raw/detect/mixed_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "core/base/disjoint_sets.hpp"
#include "core/base/parallel.hpp"
#include "core/base/robust_deviation.hpp"
#include "core/geometry/subset.hpp"
#include "raw/detect/orient_mixture.hpp"
#include "raw/detect/surface_mixture.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using Indices = std::vector<std::uint32_t>;

/// Points that may be described anew, ascending, and the surfaces that have some of them.
struct Group {
  Indices points;
  std::vector<std::size_t> surfaces;
};

/// The points of a surface, or a connected group of free ones.
struct Part {
  Indices points;
  std::optional<std::size_t> surface;
  bool is_sure;
};

/// The parts that the neighbours of a part's points are in.
struct Surroundings {
  std::vector<std::size_t> parts = {};
  std::vector<double> shares = {};  ///< of all neighbours
};

/// Whether the points of a surface lie among their like, and scatter no more than the noise. If they do, as those of
/// two surfaces would, it is not sure. `surface_of`: by point.
bool is_sure(std::size_t number, const GrownSurface& grown, const std::vector<std::size_t>& surface_of,
             const WorkCloud& cloud, const NeighbourTable& neighbours, double noise) {
  std::ptrdiff_t own = 0;
  for (const std::uint32_t i : grown.points) {
    own += std::ranges::count_if(neighbours.of(i), [&](std::uint32_t j) { return surface_of[j] == number; });
  }
  const auto all = static_cast<double>(grown.points.size() * neighbours.width);
  if (static_cast<double>(own) < k_own_share * all) return false;
  return k_clear_share * noise_within_patches(distances_of(grown.surface, cloud, grown.points)).value_or(0) <= noise;
}

/// All surfaces, then the free points that no sure surface explains.
std::vector<Part> surfaces_and_free_groups(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                           const NeighbourTable& neighbours, const SearchLimits& limits,
                                           const RunContext& run) {
  const std::vector<std::size_t> surface_of = owners_of_points(surfaces, cloud);
  std::vector<Part> parts(surfaces.size());
  for_each_index(surfaces.size(), run, [&](std::size_t s) {
    const bool sure = is_sure(s, surfaces[s], surface_of, cloud, neighbours, limits.agreement.noise);
    parts[s] = {.points = surfaces[s].points, .surface = s, .is_sure = sure};
  });
  const Indices unexplained = beyond_reach(free_points(cloud, surfaces).list(), surfaces, cloud,
                                           [&](std::size_t s) { return parts[s].is_sure; });
  for (Indices& group : connected_groups(cloud.points, unexplained, limits.link)) {
    parts.push_back({.points = std::move(group), .surface = std::nullopt, .is_sure = false});
  }
  return parts;
}

/// A last part stands for free points that sure surfaces explain.
std::vector<Surroundings> surroundings_of(const std::vector<Part>& parts, const WorkCloud& cloud,
                                          const NeighbourTable& neighbours) {
  const std::vector<std::size_t> part_of = owners_of_points(parts, cloud);
  std::vector<Surroundings> result(parts.size());
  std::vector<std::size_t> counts(parts.size() + 1, 0);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const std::uint32_t i : parts[p].points) {
      for (const std::uint32_t j : neighbours.of(i)) {
        if (counts[part_of[j]]++ == 0) result[p].parts.push_back(part_of[j]);
      }
    }
    const auto all = static_cast<double>(std::max<std::size_t>(parts[p].points.size() * neighbours.width, 1));
    for (const std::size_t other : result[p].parts) {
      result[p].shares.push_back(static_cast<double>(std::exchange(counts[other], 0)) / all);
    }
  }
  return result;
}

template <class IsCounted>
double share_of(const Surroundings& around, const IsCounted& is_counted) {
  double sum = 0;
  for (std::size_t k = 0; k < around.parts.size(); ++k) sum += is_counted(around.parts[k]) ? around.shares[k] : 0;
  return sum;
}

/// By part: whether it is not sure, nor are most of the points around it. Others are outliers or small surfaces.
std::vector<bool> are_mixed(const std::vector<Part>& parts, const std::vector<Surroundings>& around) {
  const auto is_unsure = [&](std::size_t part) { return part < parts.size() && !parts[part].is_sure; };
  std::vector<bool> is_mixed;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double own = share_of(around[p], [&](std::size_t part) { return part == p; });
    const double unsure = share_of(around[p], is_unsure);
    const bool is_small = parts[p].surface && own < k_own_share;
    is_mixed.push_back(is_unsure(p) && (is_small ? unsure - own >= 1 - unsure : unsure >= 0.5));
  }
  is_mixed.push_back(false);
  return is_mixed;
}

/// Mixed parts that are connected by a noticeable share of the neighbours of either.
std::vector<Group> mixed_groups(const std::vector<Part>& parts, const std::vector<Surroundings>& around) {
  // Less is where two features touch.
  constexpr double k_least_share = 0.1;
  const std::vector<bool> is_mixed = are_mixed(parts, around);
  DisjointSets sets(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (std::size_t k = 0; k < around[p].parts.size(); ++k) {
      const std::size_t other = around[p].parts[k];
      if (is_mixed[p] && is_mixed[other] && around[p].shares[k] >= k_least_share) sets.join(p, other);
    }
  }
  std::vector<Group> groups(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!is_mixed[p]) continue;
    Group& group = groups[sets.root(p)];
    group.points.insert(group.points.end(), parts[p].points.begin(), parts[p].points.end());
    if (parts[p].surface) group.surfaces.push_back(*parts[p].surface);
  }
  std::erase_if(groups, [](const Group& group) { return group.points.empty(); });
  for (Group& group : groups) std::ranges::sort(group.points);
  return groups;
}

std::vector<Vector3d> positions_of(std::span<const std::uint32_t> points, const WorkCloud& cloud) {
  std::vector<Vector3d> positions;
  positions.reserve(points.size());
  for (const std::uint32_t i : points) positions.push_back(cloud.points[i].position);
  return positions;
}

double median_precision(std::span<const std::uint32_t> points, const WorkCloud& cloud) {
  std::vector<double> precisions;
  for (const std::uint32_t i : points) precisions.push_back(cloud.points[i].precision);
  return median_of(precisions);
}

/// The surfaces that the group has now.
SurfaceMixture mixture_of(const Group& group, const std::vector<GrownSurface>& surfaces) {
  SurfaceMixture mixture;
  mixture.surface_of.assign(group.points.size(), group.surfaces.size());
  for (const std::size_t s : group.surfaces) {
    for (const std::uint32_t i : surfaces[s].points) {
      const auto place = std::ranges::lower_bound(group.points, i) - group.points.begin();
      mixture.surface_of[static_cast<std::size_t>(place)] = mixture.surfaces.size();
    }
    mixture.surfaces.push_back(surfaces[s].surface);
  }
  return mixture;
}

/// Compares mixtures of a group by a sample of its points. A surface takes the share of the points around that it has,
/// so surfaces side by side are as likely as one, and those whose points lie among each other's are less likely.
class Comparison {
 public:
  Comparison(const Group& group, const WorkCloud& cloud, const NeighbourTable& neighbours)
      : points_(group.points), neighbours_(neighbours), all_(positions_of(group.points, cloud)) {
    std::vector<std::size_t> numbers(points_.size());
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    sample_ = some_of(numbers, k_sample);
    for (const std::size_t k : sample_) positions_.push_back(all_[k]);
  }

  [[nodiscard]] std::span<const Vector3d> all() const { return all_; }
  [[nodiscard]] std::span<const Vector3d> sample() const { return positions_; }

  [[nodiscard]] double cost(const SurfaceMixture& mixture, double noise) const {
    SurfaceMixture of_sample{.surfaces = mixture.surfaces};
    std::vector<double> shares;
    const std::vector<double> prior = mixture.shares();
    for (const std::size_t k : sample_) {
      of_sample.surface_of.push_back(mixture.surface_of[k]);
      std::vector<double> counts = prior;
      double sum = 1;
      for (const std::uint32_t j : neighbours_.of(points_[k])) {
        const auto place = std::ranges::lower_bound(points_, j);
        if (place == points_.end() || *place != j) continue;
        ++counts[mixture.surface_of[static_cast<std::size_t>(place - points_.begin())]];
        ++sum;
      }
      for (const double count : counts) shares.push_back(count / sum);
    }
    return cost_of(of_sample, positions_, shares, noise);
  }

 private:
  const Indices& points_;
  const NeighbourTable& neighbours_;
  std::vector<Vector3d> all_;
  std::vector<std::size_t> sample_;
  std::vector<Vector3d> positions_;
};

/// The better mixture for the group, if there is one. One surface in place of another that has nearly all points is
/// none: detection compares types with more care.
std::optional<SurfaceMixture> better_mixture(const Group& group, const std::vector<GrownSurface>& surfaces,
                                             const WorkCloud& cloud, const NeighbourTable& neighbours,
                                             const SearchLimits& limits) {
  if (group.points.size() < limits.least_points) return std::nullopt;
  const AgreementLimits agreement = limits.agreement.at(median_precision(group.points, cloud));
  const double noise = agreement.noise;
  const Comparison comparison(group, cloud, neighbours);
  const std::size_t least_of_sample = limits.least_points * comparison.sample().size() / group.points.size();
  std::optional<SurfaceMixture> best =
      fit_mixture(comparison.sample(), std::max(k_nearest, least_of_sample), agreement);
  if (!best) return std::nullopt;
  best->surface_of = nearest_surfaces(best->surfaces, comparison.all(), k_deviations * noise);
  const SurfaceMixture now = mixture_of(group, surfaces);
  const double explained = 1 - best->shares().back();
  const double explained_now = 1 - now.shares().back();
  if (explained < std::max(k_clear_share, k_nearly_all * explained_now)) return std::nullopt;
  if (best->surfaces.size() == 1 && now.surfaces.size() == 1 && explained_now >= k_nearly_all) return std::nullopt;
  for (std::size_t s = 0; s < best->surfaces.size(); ++s) {
    const auto points = static_cast<std::size_t>(std::ranges::count(best->surface_of, s));
    if (points < limits.least_points_of(best->surfaces[s].type)) return std::nullopt;
  }
  // Fewer surfaces need no evidence. Two in one place, with opposite normals, are as likely as one.
  const double least_gain = best->surfaces.size() < now.surfaces.size() ? 0 : k_evidence;
  const bool is_better = comparison.cost(*best, noise) <= comparison.cost(now, noise) - least_gain;
  return is_better ? best : std::nullopt;
}

/// The surfaces with their points, which take the normals.
MixedSurfaces grown_from(const SurfaceMixture& mixture, const Indices& points, WorkCloud& cloud,
                         const SearchLimits& limits) {
  MixedSurfaces grown;
  for (const Surface& surface : mixture.surfaces) grown.surfaces.push_back({.surface = surface, .points = {}});
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t s = mixture.surface_of[k];
    if (s == grown.surfaces.size()) continue;
    grown.surfaces[s].points.push_back(points[k]);
    OrientedPoint& point = cloud.points[points[k]];
    grown.turned.push_back({.point = points[k], .normal = point.normal});
    point.normal = normal(mixture.surfaces[s], point.position);
  }
  for (GrownSurface& g : grown.surfaces) g.reach = reach_of(g.surface, cloud, g.points, limits.agreement);
  return grown;
}

}  // namespace

MixedSurfaces replace_mixed_surfaces(std::vector<GrownSurface> surfaces, WorkCloud& cloud,
                                     const NeighbourTable& neighbours, const SearchLimits& limits,
                                     const RunContext& run) {
  const std::vector<Part> parts = surfaces_and_free_groups(surfaces, cloud, neighbours, limits, run);
  const std::vector<Group> groups = mixed_groups(parts, surroundings_of(parts, cloud, neighbours));
  std::vector<std::optional<SurfaceMixture>> mixtures(groups.size());
  for_each_index(groups.size(), run,
                 [&](std::size_t g) { mixtures[g] = better_mixture(groups[g], surfaces, cloud, neighbours, limits); });
  if (std::ranges::none_of(mixtures, [](const auto& m) { return m.has_value(); })) {
    return {.surfaces = std::move(surfaces)};
  }
  const CloudWinding winding(cloud, neighbours);
  for_each_index(groups.size(), run, [&](std::size_t g) {
    if (mixtures[g]) mixtures[g] = oriented(std::move(*mixtures[g]), groups[g].points, cloud, winding);
  });
  std::vector<bool> is_gone(surfaces.size(), false);
  MixedSurfaces result;
  std::vector<GrownSurface> added;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!mixtures[g]) continue;
    for (const std::size_t s : groups[g].surfaces) is_gone[s] = true;
    MixedSurfaces grown = grown_from(*mixtures[g], groups[g].points, cloud, limits);
    std::ranges::move(grown.surfaces, std::back_inserter(added));
    std::ranges::move(grown.turned, std::back_inserter(result.turned));
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (!is_gone[s]) result.surfaces.push_back(std::move(surfaces[s]));
  }
  std::ranges::move(added, std::back_inserter(result.surfaces));
  return result;
}

}  // namespace cloud2csg
