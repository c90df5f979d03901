#include "raw/detect/propose.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_least_sine = 0.05;  // nearly parallel normals determine neither centre nor axis

/// The midpoint of the shortest segment between two lines; absent if they are nearly parallel.
std::optional<Vector3d> meeting(const Vector3d& p, const Vector3d& u, const Vector3d& q, const Vector3d& v) {
  const double b = u.dot(v);
  const double determinant = 1 - b * b;
  if (determinant < k_least_sine * k_least_sine) return std::nullopt;
  const Vector3d w = p - q;
  const double s = (b * v.dot(w) - u.dot(w)) / determinant;
  const double t = (v.dot(w) - b * u.dot(w)) / determinant;
  return ((p + s * u) + (q + t * v)) / 2;
}

using Neighbourhood = std::span<const OrientedPoint>;

struct Columns {
  std::vector<Eigen::Vector3d> positions, normals;
  std::vector<double> precisions;
};

Columns columns_of(std::span<const OrientedPoint> points) {
  Columns columns;
  columns.positions.reserve(points.size());
  columns.normals.reserve(points.size());
  columns.precisions.reserve(points.size());
  for (const OrientedPoint& p : points) {
    columns.positions.push_back(p.position);
    columns.normals.push_back(p.normal);
    columns.precisions.push_back(p.precision);
  }
  return columns;
}

/// Whether points of a cloud of diagonal 1 can tell the surface from a simpler one.
bool is_plausible(const Surface& surface, const AgreementLimits& limits) {
  if (!surface.position.allFinite() || !surface.axis.allFinite()) return false;
  const double least = k_deviations * limits.noise;  // detectable radius
  switch (surface.type) {
    case SurfaceType::plane:
      return true;
    case SurfaceType::sphere:
    case SurfaceType::cylinder:
      return surface.radius > least && surface.radius < limits.most_radius;
    case SurfaceType::cone: {
      // Over a third of the diagonal, a cone must leave the noise around a cylinder. A flat one must leave three times
      // the noise around a plane, where the points may be those of two planes at a step: with once, every third step of
      // 5 standard deviations is lost.
      const double slope = 3 * least;
      return surface.half_angle > slope && surface.half_angle < std::numbers::pi / 2 - 3 * slope;
    }
    case SurfaceType::torus:
      return surface.minor_radius > least && surface.radius + surface.minor_radius > least &&
             surface.radius < limits.most_radius && surface.minor_radius < limits.most_radius;
  }
  return false;
}

std::optional<Surface> if_plausible(std::optional<Surface> surface, const AgreementLimits& limits) {
  return surface && is_plausible(*surface, limits) ? surface : std::nullopt;
}

/// Fits the surface to the agreeing part of the neighbourhood; absent if less than half agrees.
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

std::optional<Surface> plane_through(std::span<const OrientedPoint, 3> points) {
  const Vector3d& p = points[0].position;
  const Vector3d a = points[1].position - p;
  const Vector3d b = points[2].position - p;
  Vector3d normal = a.cross(b);
  const double length = normal.norm();
  if (!(length > k_least_sine * a.norm() * b.norm())) return std::nullopt;
  normal /= length;
  if (normal.dot(points[0].normal) < 0) normal = -normal;
  return Surface{.type = SurfaceType::plane, .position = p, .axis = normal};
}

std::optional<Surface> sphere_through(std::span<const OrientedPoint, 2> points) {
  const OrientedPoint& p = points[0];
  const OrientedPoint& q = points[1];
  const std::optional<Vector3d> centre = meeting(p.position, p.normal, q.position, q.normal);
  if (!centre) return std::nullopt;
  const double radius = ((p.position - *centre).norm() + (q.position - *centre).norm()) / 2;
  return Surface{.type = SurfaceType::sphere,
                 .position = *centre,
                 .axis = Vector3d::UnitZ(),
                 .radius = radius,
                 .concave = (p.position - *centre).dot(p.normal) < 0};
}

std::optional<Surface> cylinder_through(std::span<const OrientedPoint, 2> points) {
  const OrientedPoint& p = points[0];
  const OrientedPoint& q = points[1];
  Vector3d axis = p.normal.cross(q.normal);
  const double sine = axis.norm();
  if (sine < k_least_sine) return std::nullopt;
  axis /= sine;
  const Vector3d along = axis.dot(q.position - p.position) * axis;
  const std::optional<Vector3d> centre = meeting(p.position, p.normal, q.position - along, q.normal);
  if (!centre) return std::nullopt;
  const double radius = ((p.position - *centre).norm() + (q.position - along - *centre).norm()) / 2;
  return Surface{.type = SurfaceType::cylinder,
                 .position = *centre,
                 .axis = axis,
                 .radius = radius,
                 .concave = (p.position - *centre).dot(p.normal) < 0};
}

std::optional<Surface> cone_through(std::span<const OrientedPoint, 3> points) {
  // The apex lies in all three tangent planes.
  Eigen::Matrix3d normals;
  Vector3d offsets;
  for (std::size_t i = 0; i < 3; ++i) {
    normals.row(static_cast<Eigen::Index>(i)) = points[i].normal;
    offsets[static_cast<Eigen::Index>(i)] = points[i].normal.dot(points[i].position);
  }
  if (std::abs(normals.determinant()) < k_least_sine * k_least_sine * k_least_sine) return std::nullopt;
  const Vector3d apex = normals.partialPivLu().solve(offsets);

  // Points at unit distance from the apex on the rulings span a plane orthogonal to the axis.
  std::array<Vector3d, 3> rulings;
  for (std::size_t i = 0; i < 3; ++i) rulings[i] = (points[i].position - apex).normalized();
  Vector3d axis = (rulings[1] - rulings[0]).cross(rulings[2] - rulings[0]);
  if (!(axis.norm() > k_least_sine * k_least_sine)) return std::nullopt;
  axis.normalize();
  if (axis.dot(rulings[0]) < 0) axis = -axis;
  const Vector3d outward = rulings[0] - axis.dot(rulings[0]) * axis;
  return Surface{.type = SurfaceType::cone,
                 .position = apex,
                 .axis = axis,
                 .half_angle = std::acos(std::clamp(axis.dot(rulings[0]), 0.0, 1.0)),
                 .concave = outward.dot(points[0].normal) < 0};
}

std::optional<Surface> fit_plausible(const Surface& start, std::span<const OrientedPoint> points,
                                     const AgreementLimits& limits) {
  const Columns columns = columns_of(points);
  const std::optional<SurfaceFit> fit = fit_surface(
      start, columns.positions, {.noise = limits.distance / k_deviations, .precisions = columns.precisions});
  return if_plausible(fit ? std::optional(fit->surface) : std::nullopt, limits);
}

std::optional<Surface> fit_plausible(const Surface& start, const WorkCloud& cloud,
                                     const std::vector<std::uint32_t>& points, const AgreementLimits& limits) {
  return fit_plausible(start, cloud.some_of(points, k_large_sample), limits);
}

std::optional<Surface> estimate_plausible(SurfaceType type, std::span<const OrientedPoint> points,
                                          const AgreementLimits& limits) {
  const Columns columns = columns_of(points);
  const std::optional<Surface> start = if_plausible(estimate_surface(type, columns.positions, columns.normals), limits);
  return start ? fit_plausible(*start, points, limits) : std::nullopt;
}

std::vector<Surface> propose_surfaces(const FreePoints& points, const AgreementLimits& limits, RandomStream& random) {
  const std::vector<OrientedPoint> near = points.draw_neighbours(k_around, random);
  std::vector<Surface> proposed;
  if (near.size() < k_nearest) return proposed;
  const auto propose = [&](const std::optional<Surface>& surface) {
    if (const std::optional<Surface> sure = confirmed(surface, near, limits)) proposed.push_back(*sure);
  };
  for (std::size_t k = 1; k <= k_rounds && k + 1 < near.size() && proposed.empty(); ++k) {
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
