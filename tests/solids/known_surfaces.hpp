#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/primitive.hpp"
#include "core/primitive/profile.hpp"

/// What detection would find in a cloud of known solids.
namespace cloud2csg::test {

inline Surface plane_at(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
  return {.type = SurfaceType::plane, .position = position, .axis = normal.normalized()};
}

/// The surfaces of a solid. Of cones only those with a slope, of turned profiles those of arcs.
inline std::vector<Surface> surfaces_of(const Primitive& solid) {
  std::vector<Surface> found;
  const Eigen::Vector3d axis = solid.pose.orientation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d middle = solid.pose.position;
  const auto add_ends = [&](double height) {
    found.push_back(plane_at(middle + 0.5 * height * axis, axis));
    found.push_back(plane_at(middle - 0.5 * height * axis, -axis));
  };
  if (const auto* box = std::get_if<Box>(&solid.shape)) {
    for (int side = 0; side < 3; ++side) {
      for (const double sign : {-1.0, 1.0}) {
        const Eigen::Vector3d normal = solid.pose.orientation * Eigen::Vector3d(sign * Eigen::Vector3d::Unit(side));
        found.push_back(plane_at(middle + 0.5 * box->size[side] * normal, normal));
      }
    }
  } else if (const auto* polytope = std::get_if<Polytope>(&solid.shape)) {
    for (const Plane& plane : polytope->planes) {
      const Eigen::Vector3d normal = solid.pose.orientation * plane.normal;
      found.push_back(plane_at(middle + plane.offset * normal, normal));
    }
  } else if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) {
    found.push_back({.type = SurfaceType::sphere, .position = middle, .radius = sphere->radius});
  } else if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape)) {
    found.push_back({.type = SurfaceType::cylinder, .position = middle, .axis = axis, .radius = cylinder->radius});
    add_ends(cylinder->height);
  } else if (const auto* cone = std::get_if<Cone>(&solid.shape)) {
    const double slope = (cone->radius_top - cone->radius_bottom) / cone->height;
    const double to_apex = -0.5 * cone->height - cone->radius_bottom / slope;
    found.push_back({.type = SurfaceType::cone,
                     .position = middle + to_apex * axis,
                     .axis = slope > 0 ? axis : Eigen::Vector3d(-axis),
                     .half_angle = std::atan(std::abs(slope))});
    add_ends(cone->height);
  } else if (const auto* torus = std::get_if<Torus>(&solid.shape)) {
    found.push_back({.type = SurfaceType::torus,
                     .position = middle,
                     .axis = axis,
                     .radius = torus->major_radius,
                     .minor_radius = torus->minor_radius});
  } else if (const auto* turned = std::get_if<Revolution>(&solid.shape)) {
    for (const ProfileSegment& arc : segments_of(turned->profile.paths.at(0))) {
      if (!arc.is_arc()) continue;
      found.push_back({.type = SurfaceType::torus,
                       .position = middle + arc.centre.y() * axis,
                       .axis = axis,
                       .radius = arc.centre.x(),
                       .minor_radius = arc.radius});
    }
  }
  return found;
}

inline Eigen::Vector3d slope_at(const Surface& surface, const Eigen::Vector3d& point) {
  constexpr double k_step = 1e-6;
  Eigen::Vector3d slope;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = k_step * Eigen::Vector3d::Unit(axis);
    slope[axis] = (signed_distance(surface, point + step) - signed_distance(surface, point - step)) / (2 * k_step);
  }
  return slope;
}

/// Each point goes to the nearest surface that it lies on; which side the material is on follows from the normals.
/// Surfaces that fewer than `least_points` lie on were not found.
inline std::vector<DetectedSurface> known_surfaces(const PrimitiveSet& solids, const PointCloud& cloud,
                                                   double tolerance, std::size_t least_points = 12) {
  std::vector<DetectedSurface> found;
  for (const Primitive& solid : solids) {
    for (const Surface& surface : surfaces_of(solid)) found.push_back({.surface = surface, .points = {}, .rms = 0});
  }
  std::vector<double> votes(found.size(), 0.0);
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    double nearest = tolerance;
    std::optional<std::size_t> of;
    double agreement = 0;
    for (std::size_t s = 0; s < found.size(); ++s) {
      const double distance = std::abs(signed_distance(found[s].surface, cloud.positions[i]));
      if (distance >= nearest) continue;
      const double cosine = slope_at(found[s].surface, cloud.positions[i]).dot(cloud.normals[i]);
      if (std::abs(cosine) < 0.9) continue;
      nearest = distance;
      of = s;
      agreement = cosine;
    }
    if (!of) continue;
    found[*of].points.push_back(i);
    found[*of].rms += nearest * nearest;
    votes[*of] += agreement;
  }
  for (std::size_t s = 0; s < found.size(); ++s) {
    DetectedSurface& detected = found[s];
    detected.rms = std::sqrt(detected.rms / std::max<double>(1, static_cast<double>(detected.points.size())));
    if (votes[s] >= 0) continue;
    if (detected.surface.type == SurfaceType::plane) {
      detected.surface.axis = -detected.surface.axis;
    } else {
      detected.surface.concave = true;
    }
  }
  std::erase_if(found, [&](const DetectedSurface& detected) { return detected.points.size() < least_points; });
  return found;
}

}  // namespace cloud2csg::test
