#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <vector>

#include "cloud2csg/advanced/surface.hpp"
#include "support/random_scene.hpp"

/// Known surfaces, points on parts of them, and how far apart two surfaces are.
namespace cloud2csg::test {

inline constexpr std::array k_surface_types = {SurfaceType::plane, SurfaceType::sphere, SurfaceType::cylinder,
                                               SurfaceType::cone, SurfaceType::torus};

/// Points and what scanners say of their normals.
struct Patch {
  std::vector<Eigen::Vector3d> points, normals;
};

/// Which part of a surface: an arc around its axis (from the pole of a sphere: as wide a cap) and, of its extent, a
/// share. A whole cylinder is 2 long at a radius of 0.8.
struct PatchOptions {
  std::size_t count = 1500;
  double arc_deg = 360;
  double length = 1;
  double noise = 0;          ///< of the points, along the normal
  double normal_noise = 0;   ///< radians
  double outlier_share = 0;  ///< anywhere in a box of 4 around
};

inline constexpr double k_patch_size = 2;

/// Of about unit size, anywhere and in any direction.
inline Surface random_surface(SurfaceType type, RandomStream& random, bool concave = false, double far = 0) {
  Surface surface{.type = type, .position = random_within(1, random), .axis = random_direction(random)};
  surface.position += Eigen::Vector3d(far, -0.7 * far, 0.3 * far);
  surface.radius = type == SurfaceType::torus ? random.uniform(0.9, 1.2) : random.uniform(0.6, 1.0);
  surface.half_angle = random.uniform(0.3, 0.8);
  surface.minor_radius = random.uniform(0.25, 0.5);
  surface.concave = concave && type != SurfaceType::plane;
  return surface;
}

/// A point of the surface: `along` from 0 to 1 over its extent, `turn` around its axis.
inline Eigen::Vector3d point_on(const Surface& surface, double along, double turn, const PatchOptions& options) {
  const Eigen::Vector3d first = surface.axis.unitOrthogonal();
  const Eigen::Vector3d second = surface.axis.cross(first);
  const Eigen::Vector3d outward = std::cos(turn) * first + std::sin(turn) * second;
  const double extent = (along - 0.5) * k_patch_size * options.length;
  switch (surface.type) {
    case SurfaceType::plane:
      return surface.position + extent * first + (turn / std::numbers::pi) * second;
    case SurfaceType::sphere: {
      const double cosine = 1 - along * (1 - std::cos(options.arc_deg / 2 * std::numbers::pi / 180));
      const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
      const double anywhere = 2 * std::numbers::pi * std::fmod(turn * 7919, 1.0);
      const Eigen::Vector3d around = std::cos(anywhere) * first + std::sin(anywhere) * second;
      return surface.position + surface.radius * (cosine * surface.axis + sine * around);
    }
    case SurfaceType::cylinder:
      return surface.position + extent * surface.axis + surface.radius * outward;
    case SurfaceType::cone: {
      const double height = 1.5 + extent;
      return surface.position + height * (surface.axis + std::tan(surface.half_angle) * outward);
    }
    case SurfaceType::torus: {
      // As far as the axis, if the tube crosses it.
      const double most = std::acos(std::clamp(-surface.radius / surface.minor_radius, -1.0, 1.0));
      const double tube = (2 * along - 1) * most * options.length;
      return surface.position + (surface.radius + surface.minor_radius * std::cos(tube)) * outward +
             surface.minor_radius * std::sin(tube) * surface.axis;
    }
  }
  return {};
}

inline Patch sample_patch(const Surface& surface, const PatchOptions& options, RandomStream& random) {
  Patch patch;
  const double arc = options.arc_deg * std::numbers::pi / 180;
  for (std::size_t i = 0; i < options.count; ++i) {
    const double along = random.uniform();
    const double turn = random.uniform(-arc / 2, arc / 2);
    const Eigen::Vector3d exact = point_on(surface, along, turn, options);
    const Eigen::Vector3d outward = normal(surface, exact);
    const bool is_outlier = random.chance(options.outlier_share);
    patch.points.emplace_back(is_outlier ? surface.position + random_within(2, random)
                                         : Eigen::Vector3d(exact + options.noise * random.normal() * outward));
    const Eigen::Vector3d wrong = options.normal_noise * random_within(1, random);
    patch.normals.emplace_back(is_outlier ? random_direction(random) : (outward + wrong).normalized());
  }
  return patch;
}

/// A surface of the same type a little off: by `share` of its size, and as many radians.
inline Surface shaken(Surface surface, double share, RandomStream& random) {
  surface.position += random_within(share, random);
  surface.axis = (surface.axis + random_within(share, random)).normalized();
  surface.radius *= 1 + random.uniform(-share, share);
  surface.minor_radius *= 1 + random.uniform(-share, share);
  surface.half_angle += random.uniform(-share, share);
  return surface;
}

/// The largest distance of exact points of one surface from another: what a wrong fit is off where it matters.
inline double largest_distance(const Surface& from, const Surface& truth, PatchOptions options) {
  options.noise = 0;
  options.outlier_share = 0;
  RandomStream random(99);
  double largest = 0;
  for (const Eigen::Vector3d& point : sample_patch(truth, options, random).points) {
    largest = std::max(largest, std::abs(signed_distance(from, point)));
  }
  return largest;
}

inline double axis_angle(const Surface& a, const Surface& b) {
  return std::atan2(a.axis.cross(b.axis).norm(), std::abs(a.axis.dot(b.axis)));
}

}  // namespace cloud2csg::test

namespace cloud2csg {
inline std::ostream& operator<<(std::ostream& out, SurfaceType type) {
  return out << type_name(type);
}
}  // namespace cloud2csg
