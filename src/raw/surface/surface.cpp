#include "cloud2csg/advanced/surface.hpp"

#include <cmath>

#include "raw/surface/profile.hpp"

namespace cloud2csg {
namespace {

/// Signed distance as if the material were inside, and its gradient.
struct DistanceAndNormal {
  double distance;
  Eigen::Vector3d normal;
};

DistanceAndNormal distance_from_centre(const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& point) {
  const Eigen::Vector3d offset = point - centre;
  const double length = offset.norm();
  return {length - radius, length > 0 ? Eigen::Vector3d(offset / length) : Eigen::Vector3d::UnitZ()};
}

DistanceAndNormal distance_from_cone(const Surface& cone, const Eigen::Vector3d& point) {
  const AxialPoint at = axial_point(cone.position, cone.axis, point);
  const double sine = std::sin(cone.half_angle);
  const double cosine = std::cos(cone.half_angle);
  const bool is_behind_apex = at.height * cosine + at.radial * sine < 0;
  if (is_behind_apex) return distance_from_centre(cone.position, 0, point);
  return {at.radial * cosine - at.height * sine, cosine * at.outward - sine * cone.axis};
}

DistanceAndNormal distance_and_normal(const Surface& surface, const Eigen::Vector3d& point) {
  switch (surface.type) {
    case SurfaceType::plane:
      return {surface.axis.dot(point - surface.position), surface.axis};
    case SurfaceType::sphere:
      return distance_from_centre(surface.position, surface.radius, point);
    case SurfaceType::cylinder: {
      const AxialPoint at = axial_point(surface.position, surface.axis, point);
      return {at.radial - surface.radius, at.outward};
    }
    case SurfaceType::cone:
      return distance_from_cone(surface, point);
    case SurfaceType::torus: {
      const AxialPoint at = axial_point(surface.position, surface.axis, point);
      const ProfileDistance profile = circle_profile(surface.radius, surface.minor_radius, at);
      return {profile.distance, profile.by_radial * at.outward + profile.by_height * surface.axis};
    }
  }
  return {};
}

double side_of(const Surface& surface) {
  return surface.concave && surface.type != SurfaceType::plane ? -1.0 : 1.0;
}

}  // namespace

std::string_view type_name(SurfaceType type) {
  switch (type) {
    case SurfaceType::plane:
      return "plane";
    case SurfaceType::sphere:
      return "sphere";
    case SurfaceType::cylinder:
      return "cylinder";
    case SurfaceType::cone:
      return "cone";
    case SurfaceType::torus:
      return "torus";
  }
  return "";
}

double signed_distance(const Surface& surface, const Eigen::Vector3d& point) {
  return side_of(surface) * distance_and_normal(surface, point).distance;
}

Eigen::Vector3d normal(const Surface& surface, const Eigen::Vector3d& point) {
  return side_of(surface) * distance_and_normal(surface, point).normal;
}

std::vector<double> signed_distance(const Surface& surface, PointsView points) {
  std::vector<double> distances(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) distances[i] = signed_distance(surface, points[i]);
  return distances;
}

Points normal(const Surface& surface, PointsView points) {
  Points normals(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) normals.set(i, normal(surface, points[i]));
  return normals;
}

}  // namespace cloud2csg
