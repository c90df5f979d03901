#include "raw/detect/propose.hpp"

#include <array>

#include "raw/detect/minimal_surfaces.hpp"

namespace cloud2csg {
namespace {

using Neighbourhood = std::span<const OrientedPoint>;

constexpr std::size_t k_neighbours = 24;
/// Fewer of them say nothing; and a surface must agree with half.
constexpr std::size_t k_least_neighbours = 8;

struct Columns {
  std::vector<Eigen::Vector3d> positions, normals;
};

Columns columns_of(std::span<const OrientedPoint> points) {
  Columns columns;
  columns.positions.reserve(points.size());
  columns.normals.reserve(points.size());
  for (const OrientedPoint& p : points) {
    columns.positions.push_back(p.position);
    columns.normals.push_back(p.normal);
  }
  return columns;
}

std::optional<Surface> if_plausible(std::optional<Surface> surface, const AgreementLimits& limits) {
  return surface && is_plausible(*surface, limits) ? surface : std::nullopt;
}

/// The surface, fitted to what of the neighbourhood agrees with it, when that is half.
std::optional<Surface> confirmed(const std::optional<Surface>& surface, Neighbourhood points,
                                 const AgreementLimits& limits) {
  if (!surface || !is_plausible(*surface, limits)) return std::nullopt;
  AgreementLimits wide = limits;
  wide.distance *= 2;
  const std::vector<OrientedPoint> agreeing = agreeing_points(*surface, points, wide);
  if (2 * agreeing.size() < points.size()) return std::nullopt;
  const std::optional<Surface> fitted = fit_plausible(*surface, agreeing, limits);
  const bool is_better = fitted && support_of(*fitted, points, limits) >= support_of(*surface, points, limits);
  return is_better ? fitted : surface;
}

}  // namespace

bool is_plausible(const Surface& surface, const AgreementLimits& limits) {
  if (!surface.position.allFinite() || !surface.axis.allFinite()) return false;
  constexpr double k_most_apex = 3;          // from the middle of the cloud
  const double least = 2 * limits.distance;  // of a radius that shows
  switch (surface.type) {
    case SurfaceType::plane:
      return true;
    case SurfaceType::sphere:
    case SurfaceType::cylinder:
      return surface.radius > least && surface.radius < limits.most_radius;
    case SurfaceType::cone:
      // Sharper ones are cylinders and blunter ones planes, as far as points can tell.
      return surface.half_angle > 0.035 && surface.half_angle < 1.5 && surface.position.norm() < k_most_apex;
    case SurfaceType::torus:
      return surface.minor_radius > least && surface.radius > surface.minor_radius &&
             surface.radius < limits.most_radius;
  }
  return false;
}

std::optional<Surface> fit_plausible(const Surface& start, std::span<const OrientedPoint> points,
                                     const AgreementLimits& limits) {
  const std::optional<SurfaceFit> fit =
      fit_surface(start, columns_of(points).positions, {.noise = limits.distance / 3});
  return if_plausible(fit ? std::optional(fit->surface) : std::nullopt, limits);
}

std::optional<Surface> estimate_plausible(SurfaceType type, std::span<const OrientedPoint> points,
                                          const AgreementLimits& limits) {
  const Columns columns = columns_of(points);
  const std::optional<Surface> start = if_plausible(estimate_surface(type, columns.positions, columns.normals), limits);
  return start ? fit_plausible(*start, points, limits) : std::nullopt;
}

std::vector<Surface> propose_surfaces(const FreePoints& points, const AgreementLimits& limits, RandomStream& random) {
  const std::vector<OrientedPoint> near = points.draw_neighbours(k_neighbours, random);
  std::vector<Surface> proposed;
  if (near.size() < k_least_neighbours) return proposed;
  const auto propose = [&](const std::optional<Surface>& surface) {
    if (const std::optional<Surface> sure = confirmed(surface, near, limits)) proposed.push_back(*sure);
  };
  constexpr std::size_t k_tries = 3;
  for (std::size_t k = 1; k <= k_tries && proposed.empty(); ++k) {
    const std::array<OrientedPoint, 2> two{near[0], near[k]};
    const std::array<OrientedPoint, 3> three{near[0], near[k], near[k + 1]};
    propose(plane_through(three));
    propose(sphere_through(two));
    propose(cylinder_through(two));
    if (proposed.empty()) propose(cone_through(three));
  }
  if (proposed.empty()) propose(estimate_plausible(SurfaceType::torus, near, limits));
  return proposed;
}

}  // namespace cloud2csg
