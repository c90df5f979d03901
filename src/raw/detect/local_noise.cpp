#include "raw/detect/local_noise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/parallel.hpp"
#include "raw/prepare/constants.hpp"
#include "raw/prepare/local_fit.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// Noisy ones of the k_around patches around a point with noise: patches across steps seem noisy, too.
const std::ptrdiff_t k_least_noisy = k_around - k_around / 4;
/// A point is beside the patches, not among them, if the square of its distance from the nearest is more than the
/// square of that from the farthest over this. With 1, the noise of a plane spreads over a round surface; with 4,
/// points of noisy places stay out.
constexpr double k_beside = 2;

/// Successive points near a plane.
struct Patch {
  Vector3d middle;
  double noise;  ///< standard deviation of the distances around a slope, or around two in parallel
};

/// Standard deviation of distances around a slope of three parameters; around two slopes where BIC prefers two groups,
/// each with its mean: the points of both sides of a thin wall are not noisy. O(n log n)
double noise_of(std::vector<double> residuals) {
  const auto count = static_cast<double>(residuals.size());
  std::ranges::sort(residuals);
  const double squares = std::transform_reduce(residuals.begin(), residuals.end(), residuals.begin(), 0.0);
  double noise = std::sqrt(squares / (count - 3));
  // Minus twice the logarithm of the likelihood, by point. Two groups have two more parameters, a mean and a share.
  double least = std::log(squares / count);
  const double price = 2 * std::log(count) / count;
  double sum = residuals.front();
  for (std::size_t k = 2; k + 2 <= residuals.size(); ++k) {
    sum += residuals[k - 1];
    const double share = static_cast<double>(k) / count;
    const double entropy = -share * std::log(share) - (1 - share) * std::log1p(-share);
    const double within = squares - sum * sum / (count * share * (1 - share));
    const double cost = std::log(within / count) + 2 * entropy + price;
    if (!(cost < least)) continue;
    least = cost;
    noise = std::sqrt(within / (count - 4));
  }
  return noise;
}

/// The slope is that of a round surface that touches the plane.
Patch patch_of(const Surface& plane, std::span<const std::uint32_t> points, const WorkCloud& cloud) {
  const auto count = static_cast<double>(points.size());
  std::vector<double> distances = distances_of(plane, cloud, points);
  const Vector3d u = plane.axis.unitOrthogonal();
  const Vector3d v = plane.axis.cross(u);
  const Vector3d origin = cloud.points[points.front()].position;
  const auto terms_of = [&](const Vector3d& position) {
    return Vector3d(1, u.dot(position - origin), v.dot(position - origin));
  };
  Vector3d middle = Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Vector3d products = Vector3d::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector3d& position = cloud.points[points[k]].position;
    const Vector3d terms = terms_of(position);
    middle += position / count;
    scatter += terms * terms.transpose();
    products += distances[k] * terms;
  }
  const Vector3d slope = scatter.ldlt().solve(products);
  for (std::size_t k = 0; k < points.size(); ++k) {
    distances[k] -= slope.dot(terms_of(cloud.points[points[k]].position));
  }
  return {.middle = middle, .noise = noise_of(std::move(distances))};
}

/// Patches of the points of each plane and the free ones around it.
std::vector<Patch> patches_of(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                              const AgreementLimits& limits) {
  // With half of it, points with four times the noise seem to have two and a half times; double takes in more detail.
  constexpr double k_widest = 4;
  AgreementLimits wide = limits;
  wide.distance *= k_widest;
  wide.cosine = k_edge_cosine;
  const FreePoints free = free_points(cloud, surfaces);
  std::vector<Patch> patches;
  for (const GrownSurface& plane : surfaces) {
    if (plane.surface.type != SurfaceType::plane) continue;
    const std::vector<std::uint32_t> around =
        points_near(plane, cloud, wide, [&](std::uint32_t i) { return free.is_free(i); });
    for (std::size_t first = 0; first + k_patch <= around.size(); first += k_patch) {
      patches.push_back(patch_of(plane.surface, std::span(around).subspan(first, k_patch), cloud));
    }
  }
  return patches;
}

}  // namespace

std::vector<double> local_noise(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                const AgreementLimits& limits, const RunContext& run) {
  const std::vector<Patch> patches = patches_of(surfaces, cloud, limits);
  const double usual = limits.distance / k_deviations;
  const auto is_noisy = [&](double noise) { return usual < k_clear_share * noise; };
  const auto noisy_patches = std::ranges::count_if(patches, is_noisy, &Patch::noise);
  if (patches.size() < k_around || noisy_patches < k_least_noisy) return {};
  Points middles(patches.size());
  for (std::size_t p = 0; p < patches.size(); ++p) middles.set(p, patches[p].middle);
  const NeighbourTree tree(middles);
  std::vector<double> noise(cloud.size(), 1);
  for_each_index(cloud.size(), run, [&](std::size_t i) {
    std::vector<std::uint32_t> near(k_around);
    std::vector<double> squares(k_around);
    tree.find(cloud.points[i].position, near, squares);
    if (k_beside * squares.front() > squares.back()) return;
    std::vector<double> noises;
    noises.reserve(near.size());
    for (const std::uint32_t p : near) noises.push_back(patches[p].noise);
    const auto least = noises.end() - k_least_noisy;
    std::ranges::nth_element(noises, least);
    if (is_noisy(*least)) noise[i] = *least / usual;
  });
  // With half of it, undetected detail of scans counts as noise; with double, noise makes false surfaces.
  constexpr double k_much_more = 2;
  std::size_t noisy = 0;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noisy += noise[i] > 1 && noise[i] / cloud.points[i].precision > k_much_more ? 1U : 0U;
  }
  return static_cast<double>(noisy) < k_negligible_share * static_cast<double>(noise.size()) ? std::vector<double>{}
                                                                                             : noise;
}

void account_for_noise(WorkCloud& cloud, const std::vector<double>& local_noise, Scale scale, const RunContext& run) {
  const double noise = scale.noise / cloud.diagonal;
  double least = 1;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.points[i].precision /= local_noise[i];
    least = std::min(least, cloud.points[i].precision);
  }
  cloud.runs = runs_of(cloud.points);
  const Points positions = cloud.positions();
  scale.noise /= least;
  const NeighbourTable near = find_neighbours(positions, NeighbourTree(positions), plane_neighbours(scale), run);
  const std::vector<OrientedPoint> before = cloud.points;
  for_each_index(cloud.size(), run, [&](std::size_t i) {
    if (local_noise[i] == 1) return;
    OrientedPoint& point = cloud.points[i];
    point.normal = fit_local_plane(positions, i, near, noise / point.precision, k_bend_tolerance).normal;
    double votes = 0;
    for (const std::uint32_t j : near.of(i)) votes += before[j].normal.dot(point.normal);
    if (votes < 0) point.normal = -point.normal;
  });
}

}  // namespace cloud2csg
