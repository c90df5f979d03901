#include "peers/efficient_ransac.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/Shape_detection/Efficient_RANSAC.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace cloud2csg::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = std::pair<Kernel::Point_3, Kernel::Vector_3>;
using PositionMap = CGAL::First_of_pair_property_map<Point>;
using NormalMap = CGAL::Second_of_pair_property_map<Point>;
using Traits = CGAL::Shape_detection::Efficient_RANSAC_traits<Kernel, std::vector<Point>, PositionMap, NormalMap>;
using Ransac = CGAL::Shape_detection::Efficient_RANSAC<Traits>;
using Shape = Ransac::Shape;

template <typename Triple>
Eigen::Vector3d vector_of(const Triple& v) {
  return {v.x(), v.y(), v.z()};
}

std::optional<Surface> surface_of(Shape& shape) {
  namespace shapes = CGAL::Shape_detection;
  if (const auto* plane = dynamic_cast<shapes::Plane<Traits>*>(&shape)) {
    const Eigen::Vector3d axis = vector_of(plane->plane_normal()).normalized();
    return Surface{.type = SurfaceType::plane, .position = vector_of(Kernel::Plane_3(*plane).point()), .axis = axis};
  }
  if (const auto* sphere = dynamic_cast<shapes::Sphere<Traits>*>(&shape)) {
    return Surface{
        .type = SurfaceType::sphere, .position = vector_of(sphere->center()), .radius = std::abs(sphere->radius())};
  }
  if (const auto* cylinder = dynamic_cast<shapes::Cylinder<Traits>*>(&shape)) {
    return Surface{.type = SurfaceType::cylinder,
                   .position = vector_of(cylinder->axis().point()),
                   .axis = vector_of(cylinder->axis().to_vector()).normalized(),
                   .radius = std::abs(cylinder->radius())};
  }
  if (const auto* cone = dynamic_cast<shapes::Cone<Traits>*>(&shape)) {
    return Surface{.type = SurfaceType::cone,
                   .position = vector_of(cone->apex()),
                   .axis = vector_of(cone->axis()).normalized(),
                   .half_angle = cone->angle()};
  }
  if (const auto* torus = dynamic_cast<shapes::Torus<Traits>*>(&shape)) {
    return Surface{.type = SurfaceType::torus,
                   .position = vector_of(torus->center()),
                   .axis = vector_of(torus->axis()).normalized(),
                   .radius = torus->major_radius(),
                   .minor_radius = torus->minor_radius()};
  }
  return std::nullopt;
}

/// CGAL's surfaces have no side. Turns the surface to the side of most of its points' normals.
void face_points(Surface& surface, const std::vector<std::uint32_t>& points, const PointCloud& cloud) {
  double votes = 0;
  for (const std::uint32_t i : points) {
    votes += normal(surface, Eigen::Vector3d(cloud.positions[i])).dot(Eigen::Vector3d(cloud.normals[i]));
  }
  if (votes >= 0) return;
  if (surface.type == SurfaceType::plane) {
    surface.axis = -surface.axis;
  } else {
    surface.concave = !surface.concave;
  }
}

}  // namespace

std::vector<DetectedSurface> detect_by_ransac(const PreparedCloud& prepared, const RansacOptions& options) {
  constexpr double k_link_in_spacings = 4;
  std::vector<Point> points;
  for (std::size_t i = 0; i < prepared.cloud.size(); ++i) {
    const Eigen::Vector3d p = prepared.cloud.positions[i];
    const Eigen::Vector3d n = prepared.cloud.normals[i];
    points.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), Kernel::Vector_3(n.x(), n.y(), n.z()));
  }
  CGAL::get_default_random() = CGAL::Random(1);  // else seeded by the time
  Ransac ransac;
  ransac.set_input(points);
  ransac.add_shape_factory<CGAL::Shape_detection::Plane<Traits>>();
  ransac.add_shape_factory<CGAL::Shape_detection::Sphere<Traits>>();
  ransac.add_shape_factory<CGAL::Shape_detection::Cylinder<Traits>>();
  ransac.add_shape_factory<CGAL::Shape_detection::Cone<Traits>>();
  ransac.add_shape_factory<CGAL::Shape_detection::Torus<Traits>>();
  Ransac::Parameters parameters;
  parameters.epsilon = options.tolerance * prepared.scale.noise;
  parameters.cluster_epsilon = k_link_in_spacings * prepared.scale.spacing;
  parameters.min_points = options.least_points;
  ransac.detect(parameters);
  std::vector<DetectedSurface> found;
  for (const auto& shape : ransac.shapes()) {
    std::optional<Surface> surface = surface_of(*shape);
    if (!surface) continue;
    DetectedSurface detected{.surface = *surface, .points = {}};
    for (const std::size_t i : shape->indices_of_assigned_points()) {
      detected.points.push_back(static_cast<std::uint32_t>(i));
    }
    std::ranges::sort(detected.points);
    face_points(detected.surface, detected.points, prepared.cloud);
    found.push_back(std::move(detected));
  }
  return found;
}

}  // namespace cloud2csg::bench
