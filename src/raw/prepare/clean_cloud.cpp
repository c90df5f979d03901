#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "raw/prepare/neighbours.hpp"
#include "raw/prepare/outliers.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using Indices = std::vector<std::uint32_t>;

/// Of a plane among many outliers: with fewer, noise and chance look alike.
constexpr std::size_t k_suspicious_neighbours = 48;
/// A pass that leaves out this share of the points tells that there are more; scans have fewer, and sparse parts that
/// are to stay.
constexpr double k_many = 0.06;
constexpr int k_passes = 4;
constexpr double k_widest_voxel_spacings = 3.0;
constexpr double k_widest_voxel_noise = 4.0;

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

/// Of the time that a pass takes, what it fits planes for.
constexpr double k_fitting = 0.9;

/// Where outliers are many they bend the planes that judge them, so it takes some passes.
Indices without_outliers(const Points& points, Indices kept, Scale scale, CleanReport& report, const RunContext& run) {
  Strictness strictness = Strictness::trusting;
  const StageShare cleaning("clean", points.size(), "points");
  for (int pass = 0; pass < k_passes && kept.size() > k_judges; ++pass) {
    PointCloud remaining{.positions = Points(kept.size())};
    for (std::size_t i = 0; i < kept.size(); ++i) remaining.positions.set(i, points[kept[i]]);
    // Outliers pass for noise, in part: the fewer are left, the less.
    if (pass > 0) scale = estimate_scale(remaining, run);
    const StageShare of_pass = cleaning.part(pass / double{k_passes}, (pass + 1) / double{k_passes});
    const std::size_t width = strictness == Strictness::trusting ? k_judges : k_suspicious_neighbours;
    const LocalFits fits = fit_locally(remaining, width, scale.noise, run, of_pass.part(0, k_fitting));
    const std::vector<Verdict> verdicts = judge_points(fits, scale, strictness, run, of_pass.part(k_fitting, 1));
    Indices next;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (verdicts[i] == Verdict::stays) next.push_back(kept[fits.order[i]]);
      report.isolated += verdicts[i] == Verdict::isolated ? 1 : 0;
      report.off_surface += verdicts[i] == Verdict::off_surface ? 1 : 0;
    }
    std::sort(next.begin(), next.end());
    const std::size_t gone = kept.size() - next.size();
    if (static_cast<double>(gone) >= k_many * static_cast<double>(kept.size())) strictness = Strictness::suspicious;
    const bool is_settled = static_cast<double>(gone) < k_settled * static_cast<double>(kept.size());
    kept = std::move(next);
    if (is_settled) break;
  }
  cleaning.report(run, 1);
  return kept;
}

/// The first point of each voxel, in the order of the points.
Indices one_a_voxel(const Points& points, const Indices& kept, double width) {
  using Key = std::array<std::int64_t, 3>;
  std::vector<std::pair<Key, std::uint32_t>> entries;
  entries.reserve(kept.size());
  for (const std::uint32_t i : kept) {
    const Vector3d cell = (points[i] / width).array().floor();
    entries.emplace_back(Key{static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
                             static_cast<std::int64_t>(cell.z())},
                         i);
  }
  std::sort(entries.begin(), entries.end());
  Indices result;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (i == 0 || entries[i].first != entries[i - 1].first) result.push_back(entries[i].second);
  }
  std::sort(result.begin(), result.end());
  return result;
}

Indices thinned(const Points& points, Indices kept, const Scale& scale, std::size_t budget, const RunContext& run) {
  if (kept.size() <= budget) return kept;
  const double widest = std::max(k_widest_voxel_spacings * scale.spacing, k_widest_voxel_noise * scale.noise);
  double width = scale.spacing * std::sqrt(static_cast<double>(kept.size()) / static_cast<double>(budget));
  while (true) {
    run.throw_if_stopped();
    width = std::min(width, widest);
    Indices result = one_a_voxel(points, kept, width);
    if (result.size() <= budget || width >= widest) return result;
    width *= 1.02 * std::sqrt(static_cast<double>(result.size()) / static_cast<double>(budget));
  }
}

}  // namespace

CleanCloud clean_cloud(const PointCloud& cloud, const Scale& scale, const CleanOptions& options,
                       const RunContext& run) {
  validate(options);
  const CentredPoints local = centred(cloud.positions);
  CleanReport report;
  Indices kept = without_duplicates(local.points);
  report.duplicates = cloud.size() - kept.size();
  if (options.remove_outliers) kept = without_outliers(local.points, std::move(kept), scale, report, run);
  const std::size_t before = kept.size();
  kept = thinned(local.points, std::move(kept), scale, options.point_budget, run);
  report.thinned = before - kept.size();
  return {.cloud = select_points(cloud, kept), .report = report};
}

}  // namespace cloud2csg
