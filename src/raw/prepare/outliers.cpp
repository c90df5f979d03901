#include "raw/prepare/outliers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "core/base/parallel.hpp"
#include "raw/prepare/constants.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// Least inlier share of a credible neighbour's plane.
constexpr double k_planar_support = 0.4;
/// For a cloud with outliers: least inlier share above that of a random plane.
constexpr double k_beyond_chance = 0.25;
/// Share of the credible neighbours whose planes keep a point. At a corner of three faces it is about a third.
constexpr double k_least_agreement = 0.17;

using Indices = std::vector<std::uint32_t>;

/// The credible neighbours of a point.
struct Witnesses {
  std::size_t count = 0;
  std::size_t agreeing = 0;  ///< neighbours whose planes contain the point
  double usual_gap = 0.0;    ///< median gap of the neighbours
};

double gap_of(const LocalFits& fits, std::size_t point) {
  return fits.neighbours.distances_of(point)[std::min(k_nearest, fits.neighbours.width) - 1];
}

/// Whether the plane of a point is better than chance.
bool has_plane(const LocalFits& fits, std::size_t point, double noise, Strictness strictness) {
  if (strictness == Strictness::trusting) return fits.planes[point].support >= k_planar_support;
  // The share of a uniformly filled ball that a slab through its middle holds.
  const double reach = fits.neighbours.distances_of(point).back();
  const double half = std::clamp(k_deviations * noise / reach, k_bend_tolerance, 1.0);
  const double by_chance = half * (1.5 - 0.5 * half * half);
  const double beyond = std::min(by_chance + k_beyond_chance, k_clear_share);
  return fits.planes[point].support >= std::max(beyond, k_planar_support);
}

Witnesses ask_witnesses(const LocalFits& fits, std::size_t point, double noise, Strictness strictness,
                        std::span<const PointFate> fates) {
  Witnesses witnesses;
  thread_local std::vector<double> gaps;
  gaps.clear();
  for (const std::uint32_t neighbour : fits.neighbours.nearest(point, k_around)) {
    const LocalPlane& plane = fits.planes[neighbour];
    if (fates[neighbour] == PointFate::isolated || !has_plane(fits, neighbour, noise, strictness)) continue;
    ++witnesses.count;
    gaps.push_back(gap_of(fits, neighbour));
    const Vector3d to = fits.points[point] - fits.points[neighbour];
    const double height = std::abs(plane.normal.dot(to) + plane.offset);
    witnesses.agreeing += height <= k_deviations * noise + k_bend_tolerance * to.norm() ? 1 : 0;
  }
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  if (!gaps.empty()) witnesses.usual_gap = *middle;
  return witnesses;
}

/// A point with a much larger gap than its neighbours' gaps, or with few credible neighbours, is suspect.
bool are_enough(const Witnesses& witnesses, const LocalFits& fits, std::size_t point, Strictness strictness) {
  const bool is_suspect =
      strictness == Strictness::suspicious && (gap_of(fits, point) > k_wide_gap * witnesses.usual_gap ||
                                               2 * witnesses.count < std::min(k_around, fits.neighbours.width));
  // A suspected outlier lies on some planes by chance.
  const double least = is_suspect ? 2 * k_least_agreement : k_least_agreement;
  return static_cast<double>(witnesses.agreeing) >= least * static_cast<double>(witnesses.count);
}

bool is_on_surface(const LocalFits& fits, std::size_t point, double noise, Strictness strictness,
                   std::span<const PointFate> fates) {
  const Witnesses witnesses = ask_witnesses(fits, point, noise, strictness, fates);
  // A wire or a speck has no planes around it.
  if (witnesses.count < k_nearest) return has_plane(fits, point, noise, strictness);
  return are_enough(witnesses, fits, point, strictness);
}

/// Judges far points again that had isolated ones among their witnesses: outliers lie on each other's planes by chance.
/// Repeats until all witnesses stay.
void isolate_without_witnesses(const LocalFits& fits, const Indices& far, double noise, Strictness strictness,
                               std::vector<PointFate>& fates) {
  Indices isolated;
  do {
    isolated.clear();
    for (const std::uint32_t i : far) {
      const std::span<const std::uint32_t> near = fits.neighbours.of(i);
      const auto is_isolated = [&](std::uint32_t j) { return fates[j] == PointFate::isolated; };
      if (is_isolated(i) || std::ranges::none_of(near, is_isolated)) continue;
      const Witnesses witnesses = ask_witnesses(fits, i, noise, strictness, fates);
      if (witnesses.count < k_nearest || !are_enough(witnesses, fits, i, strictness)) isolated.push_back(i);
    }
    for (const std::uint32_t i : isolated) fates[i] = PointFate::isolated;
  } while (!isolated.empty());
}

/// A pass that removes this share indicates many outliers. Clean scans lose less, and have sparse parts that must stay.
constexpr double k_many = 0.06;
/// Width of voxels in spacings or deviations of the noise; wider ones would lose details.
constexpr double k_widest_voxel = 3.0;

Indices without_duplicates(const Points& points) {
  Indices order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto place = [&points](std::uint32_t i) { return std::tuple(points.x[i], points.y[i], points.z[i]); };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(place(a), a) < std::pair(place(b), b); });
  order.erase(
      std::unique(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return place(a) == place(b); }),
      order.end());
  std::sort(order.begin(), order.end());
  return order;
}

/// Several passes, because many outliers bend the planes that judge them.
KeptPoints without_outliers(const Points& points, Indices kept, Scale scale, const RunContext& run) {
  KeptPoints result;
  std::vector<bool> is_dense(points.size());
  const auto in_the_cloud = [&kept](Indices indices) {
    for (std::uint32_t& i : indices) i = kept[i];
    return indices;
  };
  Strictness strictness = Strictness::trusting;
  const StageShare cleaning("clean", points.size(), "points");
  for (int pass = 0; pass < k_rounds && kept.size() > k_around; ++pass) {
    PointCloud remaining{.positions = Points(kept.size())};
    for (std::size_t i = 0; i < kept.size(); ++i) remaining.positions.set(i, points[kept[i]]);
    // Outliers raise the noise estimate, so each pass measures it again.
    if (pass > 0) scale = estimate_scale(remaining, run);
    const StageShare of_pass = cleaning.part(1.0 * pass / k_rounds, (pass + 1.0) / k_rounds);
    // With few neighbours, noise and chance look alike among many outliers.
    const std::size_t width = strictness == Strictness::trusting ? k_around : 2 * k_around;
    const LocalFits fits = fit_locally(remaining, width, scale.noise, run, of_pass.part(0, 0.9));
    const std::vector<PointFate> fates = judge_points(fits, scale, strictness, run, of_pass.part(0.9, 1));
    if (pass == 0) {
      const std::vector<bool> dense = dense_points(fits, scale);
      for (std::size_t i = 0; i < kept.size(); ++i) is_dense[kept[i]] = dense[i];
    }
    const KeptPoints now = kept_points(fates, fits, [&](std::uint32_t i) { return is_dense[kept[i]]; });
    result.isolated += now.isolated;
    result.off_surface += now.off_surface;
    const Indices doubted = in_the_cloud(now.doubted);
    result.doubted.insert(result.doubted.end(), doubted.begin(), doubted.end());
    const std::size_t gone = kept.size() - now.sure.size();
    if (static_cast<double>(gone) >= k_many * static_cast<double>(kept.size())) strictness = Strictness::suspicious;
    const bool is_settled = static_cast<double>(gone) < k_negligible_share * static_cast<double>(kept.size());
    kept = in_the_cloud(now.sure);
    if (is_settled) break;
  }
  cleaning.report(run, 1);
  result.sure = std::move(kept);
  std::sort(result.doubted.begin(), result.doubted.end());
  return result;
}

/// The first point of each voxel, a sure one where there is any.
KeptPoints one_a_voxel(const Points& points, const KeptPoints& kept, double width) {
  using Key = std::array<std::int64_t, 3>;
  std::vector<std::tuple<Key, bool, std::uint32_t>> entries;
  entries.reserve(kept.sure.size() + kept.doubted.size());
  const auto enter = [&](const Indices& indices, bool is_doubted) {
    for (const std::uint32_t i : indices) {
      const Vector3d cell = (points[i] / width).array().floor();
      entries.emplace_back(Key{static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
                               static_cast<std::int64_t>(cell.z())},
                           is_doubted, i);
    }
  };
  enter(kept.sure, false);
  enter(kept.doubted, true);
  std::sort(entries.begin(), entries.end());
  KeptPoints result = kept;
  result.sure.clear();
  result.doubted.clear();
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto& [cell, is_doubted, i] = entries[k];
    if (k == 0 || cell != std::get<Key>(entries[k - 1])) (is_doubted ? result.doubted : result.sure).push_back(i);
  }
  std::sort(result.sure.begin(), result.sure.end());
  std::sort(result.doubted.begin(), result.doubted.end());
  return result;
}

/// The budget is that of the sure points: most of the others may be left out later.
KeptPoints thinned(const Points& points, KeptPoints kept, const Scale& scale, std::size_t budget,
                   const RunContext& run) {
  if (kept.sure.size() <= budget) return kept;
  const double widest = k_widest_voxel * std::max(scale.spacing, scale.noise);
  double width = scale.spacing * std::sqrt(static_cast<double>(kept.sure.size()) / static_cast<double>(budget));
  while (true) {
    run.throw_if_stopped();
    width = std::min(width, widest);
    KeptPoints result = one_a_voxel(points, kept, width);
    if (result.sure.size() <= budget || width >= widest) return result;
    width *= 1.02 * std::sqrt(static_cast<double>(result.sure.size()) / static_cast<double>(budget));
  }
}

}  // namespace

std::vector<PointFate> judge_points(const LocalFits& fits, const Scale& scale, Strictness strictness,
                                    const RunContext& run, const StageShare& share) {
  const std::size_t count = fits.points.size();
  std::vector<PointFate> fates(count, PointFate::stays);
  if (fits.neighbours.width < k_nearest) return fates;
  const std::vector<PointFate> initial = fates;  // others write the new ones
  const auto is_far = [&](std::size_t i) {
    return fits.neighbours.distances_of(i)[k_nearest - 1] > k_isolated_spacings * scale.spacing;
  };
  for_each_index_by_chunks(count, k_chunk_points, run, share, [&](std::size_t i) {
    if (is_on_surface(fits, i, scale.noise, strictness, initial)) return;
    fates[i] = is_far(i) ? PointFate::isolated : PointFate::off_surface;
  });
  Indices far;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (fates[i] == PointFate::stays && is_far(i)) far.push_back(i);
  }
  isolate_without_witnesses(fits, far, scale.noise, strictness, fates);
  return fates;
}

std::vector<bool> dense_points(const LocalFits& fits, const Scale& scale) {
  const double usual_gap = scale.spacing * std::sqrt(k_nearest / std::numbers::pi);
  std::vector<bool> is_dense(fits.order.size());
  for (std::size_t i = 0; i < fits.order.size(); ++i) {
    is_dense[fits.order[i]] = gap_of(fits, i) <= k_wide_gap * usual_gap;
  }
  return is_dense;
}

KeptPoints kept_points(std::span<const PointFate> fates, const LocalFits& fits,
                       const std::function<bool(std::uint32_t point)>& is_dense) {
  KeptPoints kept;
  for (std::size_t i = 0; i < fates.size(); ++i) {
    const std::uint32_t point = fits.order[i];
    if (fates[i] == PointFate::stays) {
      kept.sure.push_back(point);
    } else if (is_dense(point)) {
      kept.doubted.push_back(point);
    } else {
      (fates[i] == PointFate::isolated ? kept.isolated : kept.off_surface) += 1;
    }
  }
  std::sort(kept.sure.begin(), kept.sure.end());
  std::sort(kept.doubted.begin(), kept.doubted.end());
  return kept;
}

std::vector<std::uint32_t> both(const KeptPoints& kept) {
  std::vector<std::uint32_t> all;
  std::merge(kept.sure.begin(), kept.sure.end(), kept.doubted.begin(), kept.doubted.end(), std::back_inserter(all));
  return all;
}

std::vector<std::uint32_t> places_in(std::span<const std::uint32_t> all, std::span<const std::uint32_t> some) {
  std::vector<std::uint32_t> places;
  for (const std::uint32_t i : some) {
    const auto found = std::lower_bound(all.begin(), all.end(), i);
    if (found != all.end() && *found == i) places.push_back(static_cast<std::uint32_t>(found - all.begin()));
  }
  return places;
}

CleanCloud clean_cloud(const PointCloud& cloud, const Scale& scale, const CleanOptions& options,
                       const RunContext& run) {
  validate(options);
  const CentredPoints local = centred(cloud.positions);
  KeptPoints kept{.sure = without_duplicates(local.points), .doubted = {}};
  CleanReport report{.duplicates = cloud.size() - kept.sure.size()};
  if (options.remove_outliers) kept = without_outliers(local.points, std::move(kept.sure), scale, run);
  report.isolated = kept.isolated;
  report.off_surface = kept.off_surface;
  const std::size_t before = kept.sure.size() + kept.doubted.size();
  kept = thinned(local.points, std::move(kept), scale, options.point_budget, run);
  const Indices left = both(kept);
  report.thinned = before - left.size();
  return {.cloud = select_points(cloud, left), .report = report, .doubted = places_in(left, kept.doubted)};
}

}  // namespace cloud2csg
