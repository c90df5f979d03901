#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/parallel.hpp"
#include "core/geometry/subset.hpp"
#include "raw/prepare/constants.hpp"
#include "raw/prepare/local_fit.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_least_points = 10;
constexpr std::array<std::size_t, 5> k_sizes{24, 48, 96, 192, 384};  ///< neighbourhoods for fitting quadrics
/// A neighbourhood with fewer deviations in its radius is a ball of noise, and its plane is chance. Half as much is
/// such a ball, twice as much takes neighbourhoods that reach around edges and across walls.
constexpr double k_least_radius = 4.0;
/// Quantile of the sample's deviations; edges and details are above.
constexpr double k_smooth_share = 0.35;
constexpr std::uint64_t k_sampling_stage = 0x7363'616c'65;

double quantile(std::vector<double> values, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

struct Neighbourhoods {
  std::vector<double> spacings;
  std::vector<double> radii;
  std::vector<double> deviations;
};

Neighbourhoods measure(const Points& points, const NeighbourTree& tree, std::span<const std::uint32_t> sample,
                       std::size_t size, const RunContext& run) {
  Neighbourhoods result;
  for (std::vector<double>* values : {&result.spacings, &result.radii, &result.deviations}) {
    values->resize(sample.size());
  }
  for_each_index((sample.size() + k_chunk_points - 1) / k_chunk_points, run, [&](std::size_t chunk) {
    std::vector<std::uint32_t> indices(std::min(size, points.size()));
    std::vector<double> squares(indices.size());
    const std::size_t end = std::min(sample.size(), (chunk + 1) * k_chunk_points);
    for (std::size_t s = chunk * k_chunk_points; s < end; ++s) {
      tree.find(points[sample[s]], indices, squares);
      const std::size_t near = std::min(k_nearest, indices.size() - 1);
      result.spacings[s] = std::sqrt(std::numbers::pi * squares[near] / static_cast<double>(near));
      result.radii[s] = std::sqrt(squares.back());
      result.deviations[s] = indices.size() < 12 ? 0.0 : quadric_deviation(points, indices);
    }
  });
  return result;
}

/// At very uneven density, only the denser half: even many outliers are mostly elsewhere.
Neighbourhoods credible(const Neighbourhoods& found) {
  if (quantile(found.radii, 0.8) < k_wide_gap * quantile(found.radii, 0.2)) return found;
  const double limit = quantile(found.radii, 0.5);
  Neighbourhoods dense;
  for (std::size_t s = 0; s < found.radii.size(); ++s) {
    if (found.radii[s] > limit) continue;
    dense.radii.push_back(found.radii[s]);
    dense.deviations.push_back(found.deviations[s]);
  }
  return dense;
}

/// Share of the noise that remains in neighbourhoods of a flat surface, by their radius in deviations: a ball cuts off
/// what lies far from its centre, and the fit follows the rest. Fitted to simulated planes with noise of 1 to 3
/// spacings.
double seen_share(double radius_ratio) {
  constexpr double k_ratio_of_ball = 2.58;  // where nothing but noise is in the ball
  constexpr double k_least_share = 0.55;    // at a ratio of 3; below it, noise fills the ball
  return std::sqrt(std::max(k_least_share * k_least_share, 1.0 - std::pow(k_ratio_of_ball / radius_ratio, 2.5)));
}

/// Uses the smallest neighbourhoods that the noise allows. Larger ones have more edges and take longer. If noise fills
/// all of them, the largest counts.
void measure_spacing_and_noise(Scale& scale, const Points& points, const NeighbourTree& tree, const RunContext& run) {
  const std::vector<std::uint32_t> sample =
      one_of_every_few(points.size(), k_sample, RandomStream(0, k_sampling_stage));
  for (const std::size_t size : k_sizes) {
    if (size > k_sizes.front() && size > points.size() / 4) break;
    const Neighbourhoods found = measure(points, tree, sample, size, run);
    if (size == k_sizes.front()) scale.spacing = quantile(found.spacings, 0.5);
    const Neighbourhoods some = credible(found);
    const double deviation = quantile(some.deviations, k_smooth_share);
    const double ratio = deviation > 0.0 ? quantile(some.radii, 0.5) / deviation : k_least_radius;
    scale.noise = deviation / seen_share(ratio);
    if (ratio >= k_least_radius) break;
  }
}

/// Points beyond the outer quantiles along an axis count only if other points are near.
AlignedBox box_without_strays(const Points& points, const NeighbourTree& tree, double spacing) {
  Vector3d low;
  Vector3d high;
  const std::array<const std::vector<double>*, 3> axes{&points.x, &points.y, &points.z};
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = quantile(*axes[static_cast<std::size_t>(axis)], k_negligible_share);
    high[axis] = quantile(*axes[static_cast<std::size_t>(axis)], 1.0 - k_negligible_share);
  }
  AlignedBox box(low, high);
  const AlignedBox core = box;
  std::vector<std::uint32_t> indices(k_nearest + 1);
  std::vector<double> squares(k_nearest + 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (core.contains(points[i])) continue;
    const std::size_t found = tree.find(points[i], indices, squares);
    if (std::sqrt(squares[found - 1]) <= k_isolated_spacings * spacing) box.extend(points[i]);
  }
  return box;
}

}  // namespace

Scale estimate_scale(const PointCloud& cloud, const RunContext& run) {
  if (cloud.size() < k_least_points) {
    throw Error({.where = "cloud",
                 .expected = fmt::format("expected at least {} points, found {}", k_least_points, cloud.size())});
  }
  const CentredPoints local = centred(cloud.positions);
  const NeighbourTree tree(local.points);
  run.throw_if_stopped();
  Scale scale;
  measure_spacing_and_noise(scale, local.points, tree, run);
  scale.box = box_without_strays(local.points, tree, scale.spacing);
  scale.diagonal = scale.box.diagonal().norm();
  scale.box.translate(local.centre);
  if (!(scale.diagonal > 0.0) || !(scale.spacing > 0.0)) {
    throw Error({.where = "cloud",
                 .expected = "expected points at different places, found most of them at the same place",
                 .remedy = "remove repeated points"});
  }
  return scale;
}

}  // namespace cloud2csg
