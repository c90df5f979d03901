#include "raw/detect/minimal_surfaces.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_least_sine = 0.05;  // normals that are nearly parallel tell neither a centre nor an axis

/// Where two lines pass each other: the middle of the shortest way, absent when they are nearly parallel.
std::optional<Vector3d> meeting(const Vector3d& p, const Vector3d& u, const Vector3d& q, const Vector3d& v) {
  const double b = u.dot(v);
  const double determinant = 1 - b * b;
  if (determinant < k_least_sine * k_least_sine) return std::nullopt;
  const Vector3d w = p - q;
  const double s = (b * v.dot(w) - u.dot(w)) / determinant;
  const double t = (v.dot(w) - b * u.dot(w)) / determinant;
  return ((p + s * u) + (q + t * v)) / 2;
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
  // The apex lies in the tangent planes of all three.
  Eigen::Matrix3d normals;
  Vector3d offsets;
  for (std::size_t i = 0; i < 3; ++i) {
    normals.row(static_cast<Eigen::Index>(i)) = points[i].normal;
    offsets[static_cast<Eigen::Index>(i)] = points[i].normal.dot(points[i].position);
  }
  if (std::abs(normals.determinant()) < k_least_sine * k_least_sine * k_least_sine) return std::nullopt;
  const Vector3d apex = normals.partialPivLu().solve(offsets);

  // One step from the apex along each ruling: the axis is square to the plane through these places.
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

}  // namespace cloud2csg
