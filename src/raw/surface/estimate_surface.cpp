#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "cloud2csg/advanced/surface.hpp"
#include "raw/surface/profile.hpp"
#include "raw/surface/unit_frame.hpp"

namespace cloud2csg {
namespace {

constexpr double k_flat = 1e-6;  // relative to the largest scatter: zero up to rounding

using Vectors = std::span<const Eigen::Vector3d>;

Eigen::Vector3d mean_of(Vectors vectors) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vector : vectors) sum += vector;
  return sum / static_cast<double>(vectors.size());
}

/// Principal directions and variances around a place, in ascending order.
Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scatter_of(Vectors vectors, const Eigen::Vector3d& around) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& vector : vectors) sum += (vector - around) * (vector - around).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum / static_cast<double>(vectors.size()));
}

/// Whether the normals point to the inside of the surface.
bool is_concave(const Surface& surface, Vectors points, Vectors normals) {
  double agreement = 0;
  for (std::size_t i = 0; i < points.size(); ++i) agreement += normals[i].dot(normal(surface, points[i]));
  return agreement < 0;
}

bool is_usable(const Surface& surface) {
  return surface.position.allFinite() && surface.axis.allFinite() && std::isfinite(surface.radius) &&
         std::isfinite(surface.minor_radius);
}

std::optional<Surface> estimate_plane(Vectors points, Vectors normals) {
  const Eigen::Vector3d centre = mean_of(points);
  const auto scatter = scatter_of(points, centre);
  if (scatter.eigenvalues()[1] <= k_flat * k_flat * scatter.eigenvalues()[2]) return std::nullopt;
  const Eigen::Vector3d across = scatter.eigenvectors().col(0);
  return Surface{.type = SurfaceType::plane,
                 .position = centre,
                 .axis = across.dot(mean_of(normals)) < 0 ? Eigen::Vector3d(-across) : across};
}

/// |p|^2 = 2 c.p + (r^2 - |c|^2) is linear in c and the rest.
std::optional<Surface> estimate_sphere(Vectors points, Vectors /*normals*/) {
  Eigen::MatrixX4d terms(points.size(), 4);
  Eigen::VectorXd squares(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    terms.row(row) << 2 * points[i].transpose(), 1;
    squares[row] = points[i].squaredNorm();
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixX4d> parts(terms);
  parts.setThreshold(k_flat);
  if (parts.rank() < 4) return std::nullopt;
  const Eigen::Vector4d found = parts.solve(squares);
  const Eigen::Vector3d centre = found.head<3>();
  return Surface{.type = SurfaceType::sphere, .position = centre, .radius = std::sqrt(found[3] + centre.squaredNorm())};
}

struct Circle {
  Eigen::Vector2d centre;
  double radius;
};

std::optional<Circle> estimate_circle(std::span<const Eigen::Vector2d> points) {
  Eigen::MatrixX3d terms(points.size(), 3);
  Eigen::VectorXd squares(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    terms.row(row) << 2 * points[i].transpose(), 1;
    squares[row] = points[i].squaredNorm();
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> parts(terms);
  parts.setThreshold(k_flat);
  if (parts.rank() < 3) return std::nullopt;
  const Eigen::Vector3d found = parts.solve(squares);
  const Eigen::Vector2d centre = found.head<2>();
  return Circle{.centre = centre, .radius = std::sqrt(found[2] + centre.squaredNorm())};
}

/// Axis and radius of the circle that fits the points' projections along `axis`, as a torus without a tube.
std::optional<Surface> axis_around(const Eigen::Vector3d& axis, std::span<const Eigen::Vector3d> points) {
  const Eigen::Vector3d first = axis.unitOrthogonal();
  const Eigen::Vector3d second = axis.cross(first);
  std::vector<Eigen::Vector2d> across;
  across.reserve(points.size());
  for (const Eigen::Vector3d& point : points) across.emplace_back(first.dot(point), second.dot(point));
  const std::optional<Circle> circle = estimate_circle(across);
  if (!circle) return std::nullopt;
  return Surface{.type = SurfaceType::torus,
                 .position = circle->centre.x() * first + circle->centre.y() * second,
                 .axis = axis,
                 .radius = circle->radius};
}

std::optional<Surface> estimate_cylinder(Vectors points, Vectors normals) {
  const auto scatter = scatter_of(normals, Eigen::Vector3d::Zero());
  if (scatter.eigenvalues()[1] <= k_flat * scatter.eigenvalues()[2]) return std::nullopt;
  const Eigen::Vector3d axis = scatter.eigenvectors().col(0);
  std::optional<Surface> cylinder = axis_around(axis, points);
  if (cylinder) cylinder->type = SurfaceType::cylinder;
  return cylinder;
}

/// The point nearest to all tangent planes.
std::optional<Eigen::Vector3d> common_point_of_tangent_planes(Vectors points, Vectors normals) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += normals[i] * normals[i].transpose();
    right += normals[i] * normals[i].dot(points[i]);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(sum);
  if (parts.eigenvalues()[0] <= k_flat * parts.eigenvalues()[2]) return std::nullopt;
  return parts.eigenvectors() *
         parts.eigenvalues().cwiseInverse().cwiseProduct(parts.eigenvectors().transpose() * right);
}

std::optional<Surface> estimate_cone(Vectors points, Vectors normals) {
  const std::optional<Eigen::Vector3d> apex = common_point_of_tangent_planes(points, normals);
  if (!apex) return std::nullopt;
  // The normals lie on a circle around the axis.
  const auto scatter = scatter_of(normals, mean_of(normals));
  if (scatter.eigenvalues()[1] <= k_flat * k_flat) return std::nullopt;
  Eigen::Vector3d axis = scatter.eigenvectors().col(0);
  if (axis.dot(mean_of(points) - *apex) < 0) axis = -axis;
  std::vector<double> angles;
  angles.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    const AxialPoint at = axial_point(*apex, axis, point);
    angles.push_back(std::atan2(at.radial, at.height));
  }
  const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
  std::ranges::nth_element(angles, middle);
  if (*middle <= 0 || *middle >= std::numbers::pi / 2) return std::nullopt;
  return Surface{.type = SurfaceType::cone, .position = *apex, .axis = axis, .half_angle = *middle};
}

/// Candidate axes of a torus, each as a torus without size.
using Axes = std::vector<Surface>;

/// The lines that come nearest to meeting all normals' lines: axes of their linear complex, ignoring its pitch. A line
/// with direction n has moment p x n and meets the line (w, m) where n.m + (p x n).w = 0.
Axes common_lines_of_normals(Vectors points, Vectors normals) {
  Eigen::Matrix3d by_moment = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d by_direction = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d moment = points[i].cross(normals[i]);
    by_moment += normals[i] * normals[i].transpose();
    by_direction += moment * moment.transpose();
    mixed += normals[i] * moment.transpose();
  }
  // Each unit direction has a best moment. These directions have the least residual.
  const Eigen::Matrix3d moment_of = -by_moment.inverse() * mixed;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> directions(by_direction + mixed.transpose() * moment_of);
  Axes axes;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d axis = directions.eigenvectors().col(i);
    axes.push_back({.type = SurfaceType::torus, .position = axis.cross(moment_of * axis), .axis = axis});
  }
  return axes;
}

/// The axes of the circle of the tube's middles p - r n for some r. The circle is in a plane: w.p + b.n = c, b = -r w.
/// Robust against noise where a short piece of a tube hardly determines where its normals meet.
Axes axes_of_tube_middles(Vectors points, Vectors normals) {
  const Eigen::Vector3d centre = mean_of(points);
  const Eigen::Vector3d mean_normal = mean_of(normals);
  Eigen::Matrix3d of_points = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d of_normals = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d offset = points[i] - centre;
    const Eigen::Vector3d turn = normals[i] - mean_normal;
    of_points += offset * offset.transpose();
    of_normals += turn * turn.transpose();
    mixed += turn * offset.transpose();
  }
  const Eigen::Matrix3d factor_of = -of_normals.inverse() * mixed;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> directions(of_points + mixed.transpose() * factor_of);
  Axes axes;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d axis = directions.eigenvectors().col(i);
    const double tube_radius = -axis.dot(factor_of * axis);
    std::vector<Eigen::Vector3d> middles;
    middles.reserve(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) middles.emplace_back(points[k] - tube_radius * normals[k]);
    if (const auto found = axis_around(axis, middles)) axes.push_back(*found);
  }
  return axes;
}

std::optional<Surface> torus_around(Surface torus, Vectors points) {
  std::vector<Eigen::Vector2d> profile;
  profile.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    const AxialPoint at = axial_point(torus.position, torus.axis, point);
    profile.emplace_back(at.radial, at.height);
  }
  const std::optional<Circle> circle = estimate_circle(profile);
  if (!circle || !(circle->centre.x() + circle->radius > 0)) return std::nullopt;
  torus.position += circle->centre.y() * torus.axis;
  torus.radius = circle->centre.x();
  torus.minor_radius = circle->radius;
  return torus;
}

double mean_square_distance(const Surface& surface, Vectors points) {
  double squares = 0;
  for (const Eigen::Vector3d& point : points) {
    const double distance = signed_distance(surface, point);
    squares += distance * distance;
  }
  return squares / static_cast<double>(points.size());
}

std::optional<Surface> estimate_torus(Vectors points, Vectors normals) {
  // Normals in a plane or on a cone are not those of a torus.
  const auto scatter = scatter_of(normals, mean_of(normals));
  if (scatter.eigenvalues()[0] <= k_flat * k_flat) return std::nullopt;
  Axes axes = common_lines_of_normals(points, normals);
  std::ranges::copy(axes_of_tube_middles(points, normals), std::back_inserter(axes));
  std::optional<Surface> best;
  double best_square = std::numeric_limits<double>::infinity();
  for (const Surface& axis : axes) {
    const std::optional<Surface> torus = torus_around(axis, points);
    if (!torus || !is_usable(*torus)) continue;
    const double square = mean_square_distance(*torus, points);
    if (square < best_square) best = torus, best_square = square;
  }
  return best;
}

std::optional<Surface> estimate(SurfaceType type, Vectors points, Vectors normals) {
  switch (type) {
    case SurfaceType::plane:
      return estimate_plane(points, normals);
    case SurfaceType::sphere:
      return estimate_sphere(points, normals);
    case SurfaceType::cylinder:
      return estimate_cylinder(points, normals);
    case SurfaceType::cone:
      return estimate_cone(points, normals);
    case SurfaceType::torus:
      return estimate_torus(points, normals);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Surface> estimate_surface(SurfaceType type, std::span<const Eigen::Vector3d> points,
                                        std::span<const Eigen::Vector3d> normals) {
  assert(points.size() == normals.size());
  if (points.size() < 3) return std::nullopt;
  const UnitFrame frame = unit_frame(points);
  const std::vector<Eigen::Vector3d> framed = to_frame(frame, points);
  std::optional<Surface> surface = estimate(type, framed, normals);
  if (!surface || !is_usable(*surface)) return std::nullopt;
  if (type != SurfaceType::plane) surface->concave = is_concave(*surface, framed, normals);
  return from_frame(frame, *surface);
}

}  // namespace cloud2csg
