#include "raw/detect/surface_mixture.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using Positions = std::span<const Vector3d>;

/// Alternates between assigning positions and fitting, within three times the reach at first. Absent if a surface has
/// fewer points than the limit.
std::optional<SurfaceMixture> settled(std::vector<Surface> surfaces, Positions positions, std::size_t least_points,
                                      double noise) {
  SurfaceMixture mixture{.surfaces = std::move(surfaces)};
  std::vector<std::size_t> before;
  for (int round = 0; round < 3 * k_rounds; ++round) {
    const double reach = k_deviations * noise * (round < k_rounds ? 3 : 1);
    before = std::exchange(mixture.surface_of, nearest_surfaces(mixture.surfaces, positions, reach));
    if (round > k_rounds && mixture.surface_of == before) break;
    std::vector<std::vector<Vector3d>> points(mixture.surfaces.size() + 1);
    for (std::size_t k = 0; k < positions.size(); ++k) points[mixture.surface_of[k]].push_back(positions[k]);
    for (std::size_t s = 0; s < mixture.surfaces.size(); ++s) {
      if (points[s].size() < least_points) return std::nullopt;
      const std::optional<SurfaceFit> fit = fit_surface(mixture.surfaces[s], points[s], {.noise = noise});
      if (!fit) return std::nullopt;
      mixture.surfaces[s] = fit->surface;
    }
  }
  return mixture;
}

std::vector<std::vector<Surface>> starts_along_axes(Positions positions) {
  const auto count = static_cast<double>(positions.size());
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : positions) middle += p / count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : positions) scatter += (p - middle) * (p - middle).transpose() / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);  // the least first
  const Surface plane{.type = SurfaceType::plane, .position = middle, .axis = axes.eigenvectors().col(0)};
  Surface low = plane;
  Surface high = plane;
  const double half = std::sqrt(std::max(0.0, axes.eigenvalues()[0]));
  low.position -= half * plane.axis;
  high.position += half * plane.axis;
  std::vector<std::vector<Surface>> starts{{plane}, {low, high}};
  for (int k = 0; k < 3; ++k) {
    const Vector3d along = axes.eigenvectors().col(k);
    std::vector<Vector3d> radial;  // as normals, they tell the axis
    for (const Vector3d& p : positions) radial.push_back((p - middle - along.dot(p - middle) * along).normalized());
    const std::optional<Surface> cylinder = estimate_surface(SurfaceType::cylinder, positions, radial);
    if (cylinder) starts.push_back({*cylinder});
    const std::optional<Surface> sphere =
        k == 0 ? estimate_surface(SurfaceType::sphere, positions, radial) : std::nullopt;
    if (sphere) starts.push_back({*sphere});
  }
  return starts;
}

}  // namespace

std::vector<double> SurfaceMixture::shares() const {
  std::vector<double> result(surfaces.size() + 1, 0);
  for (const std::size_t s : surface_of) result[s] += 1 / static_cast<double>(surface_of.size());
  return result;
}

std::vector<std::size_t> nearest_surfaces(std::span<const Surface> surfaces, Positions positions, double reach) {
  std::vector<std::size_t> result;
  result.reserve(positions.size());
  for (const Vector3d& p : positions) {
    std::size_t nearest = surfaces.size();
    double least = reach;
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const double distance = std::abs(signed_distance(surfaces[s], p));
      if (!(distance <= least)) continue;
      nearest = s;
      least = distance;
    }
    result.push_back(nearest);
  }
  return result;
}

double cost_of(const SurfaceMixture& mixture, Positions positions, std::span<const double> shares, double noise) {
  const std::size_t none = mixture.surfaces.size();
  const auto count = static_cast<double>(positions.size());
  double squares = 0;
  double explained = 0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    if (mixture.surface_of[k] == none) continue;
    const double distance = signed_distance(mixture.surfaces[mixture.surface_of[k]], positions[k]);
    squares += distance * distance;
    ++explained;
  }
  const double own_noise = std::max(noise, std::sqrt(squares / std::max(explained, 1.0)));
  const double of_outlier = std::exp(-cost_of(k_deviations, 1));
  const std::size_t stride = shares.size() > none + 1 ? none + 1 : 0;
  double cost = 0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const std::span<const double> row = shares.subspan(k * stride, none + 1);
    double likelihood = std::max(row[none], 1 / count) * of_outlier;  // any position may be an outlier
    for (std::size_t s = 0; s < none; ++s) {
      const double off = signed_distance(mixture.surfaces[s], positions[k]) / own_noise;
      likelihood += row[s] * noise / own_noise * std::exp(-off * off / 2);
    }
    cost -= std::log(likelihood);
  }
  const std::vector<double> of_all = mixture.shares();
  for (std::size_t s = 0; s < none; ++s) {
    const auto parameters = static_cast<double>(count_parameters(mixture.surfaces[s].type));
    cost += parameters / 2 * std::log(std::max(of_all[s] * count, 1.0));
  }
  return cost;
}

std::optional<SurfaceMixture> fit_mixture(Positions positions, std::size_t least_points,
                                          const AgreementLimits& limits) {
  // The points of a line with noise are 1.25 standard deviations off it on average, as those of a cylinder are. Unlike
  // proposals from normals, a cylinder of less than three is one, as all points around it are known.
  constexpr double k_least_radius = 1.5;
  const auto is_plausible = [&](const SurfaceMixture& m) {
    const Surface& first = m.surfaces.front();
    if (first.type != SurfaceType::plane) {
      return first.radius > k_least_radius * limits.noise && first.radius < limits.most_radius;
    }
    return std::abs(first.axis.dot(m.surfaces.back().axis)) >= k_alike_cosine;
  };
  std::optional<SurfaceMixture> best;
  double least = 0;
  for (std::vector<Surface>& start : starts_along_axes(positions)) {
    std::optional<SurfaceMixture> mixture = settled(std::move(start), positions, least_points, limits.noise);
    if (!mixture || !is_plausible(*mixture)) continue;
    const double cost = cost_of(*mixture, positions, mixture->shares(), limits.noise);
    if (best && !(cost < least)) continue;
    best = std::move(mixture);
    least = cost;
  }
  return best;
}

}  // namespace cloud2csg
