#include "view/report/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/robust_deviation.hpp"
#include "core/geometry/spatial_order.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_worst = 12;

/// The farthest points, at a distance from each other, so that an outlier stands for its neighbours.
std::vector<std::uint32_t> worst_points(const PointCloud& cloud, std::span<const double> distances) {
  constexpr double k_apart = 0.02;  // share of the diagonal
  constexpr std::size_t k_candidates = 4096;
  std::vector<std::uint32_t> candidates(distances.size());
  std::iota(candidates.begin(), candidates.end(), 0U);
  const auto farther = [&](std::uint32_t a, std::uint32_t b) {
    const double of_a = std::abs(distances[a]);
    const double of_b = std::abs(distances[b]);
    return of_a != of_b ? of_a > of_b : a < b;
  };
  const std::size_t count = std::min(k_candidates, candidates.size());
  std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count), candidates.end(),
                    farther);
  candidates.resize(count);
  const double apart = k_apart * bounds_of(cloud.positions).diagonal().norm();
  std::vector<std::uint32_t> worst;
  for (const std::uint32_t i : candidates) {
    if (worst.size() == k_worst) break;
    const bool is_new = std::all_of(worst.begin(), worst.end(), [&](std::uint32_t other) {
      return (cloud.positions[i] - cloud.positions[other]).norm() > apart;
    });
    if (is_new) worst.push_back(i);
  }
  return worst;
}

std::vector<OwnerDeviation> by_primitive(const PointFit& fit, std::size_t primitives) {
  std::vector<std::vector<double>> distances(primitives);
  for (std::size_t i = 0; i < fit.owners.size(); ++i) {
    if (fit.owners[i] < primitives) distances[fit.owners[i]].push_back(fit.signed_distances[i]);
  }
  std::vector<OwnerDeviation> list;
  for (std::size_t p = 0; p < primitives; ++p) {
    if (distances[p].empty()) continue;
    list.push_back({.primitive = static_cast<PrimitiveIndex>(p), .summary = summarise_deviation(distances[p])});
  }
  return list;
}

}  // namespace

DeviationSummary summarise_deviation(std::vector<double> signed_distances) {
  if (signed_distances.empty()) return {};
  DeviationSummary summary{.points = signed_distances.size()};
  const auto count = static_cast<double>(signed_distances.size());
  const auto [least, greatest] = std::minmax_element(signed_distances.begin(), signed_distances.end());
  summary.least = *least;
  summary.greatest = *greatest;
  summary.mean = std::accumulate(signed_distances.begin(), signed_distances.end(), 0.0) / count;
  summary.rms = root_mean_square(signed_distances);
  double squares = 0;
  for (const double distance : signed_distances) squares += (distance - summary.mean) * (distance - summary.mean);
  summary.standard_deviation = std::sqrt(squares / count);
  for (double& distance : signed_distances) distance = std::abs(distance);
  summary.p95 = quantile_95(signed_distances);
  return summary;
}

Deviation measure_deviation(const Model& model, const PointCloud& cloud, const RunContext& run) {
  Deviation deviation;
  const AlignedBox box = bounds_of(cloud.positions);
  deviation.order = spatial_order(cloud.positions, box, run);
  constexpr double k_near = 0.003;  // share of the diagonal: beyond most points of most scans
  deviation.fit = measure_points(model, cloud, k_near * box.diagonal().norm(),
                                 {.order = deviation.order, .with_owners = true}, run);
  const std::vector<double>& distances = deviation.fit.signed_distances;
  deviation.summary = summarise_deviation(distances);
  deviation.by_primitive = by_primitive(deviation.fit, model.primitives.size());
  deviation.worst = worst_points(cloud, distances);
  std::vector<double> sizes;
  sizes.reserve(distances.size());
  for (const double distance : distances) sizes.push_back(std::abs(distance));
  deviation.noise = robust_deviation(sizes);
  return deviation;
}

}  // namespace cloud2csg
