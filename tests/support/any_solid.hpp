#pragma once

#include <rapidcheck.h>

#include <cstdint>

#include "cloud2csg/primitive.hpp"
#include "support/any_profile.hpp"

/// Solids of every type for properties, drawn from RapidCheck's current case.
namespace cloud2csg::test {

inline double any_double(double low, double high) {
  constexpr std::uint64_t k_steps = std::uint64_t{1} << 53U;  // all bits of a double vary
  const std::uint64_t step = *rc::gen::inRange<std::uint64_t>(0, k_steps);
  return low + (high - low) * (static_cast<double>(step) * 0x1p-53);
}

inline Eigen::Vector3d any_vector(double low, double high) {
  const double x = any_double(low, high);
  const double y = any_double(low, high);
  return {x, y, any_double(low, high)};
}

/// Turned in any way, each coordinate of the position within +-reach.
inline Pose any_pose(double reach) {
  const Eigen::Vector3d position = any_vector(-reach, reach);
  const Eigen::Vector3d v = any_vector(-1, 1);
  const Eigen::Quaterniond orientation(any_double(0.1, 1), v.x(), v.y(), v.z());
  return {.position = position, .orientation = orientation.normalized()};
}

/// Any type, valid, of about unit size.
inline Shape any_shape() {
  const double a = any_double(0.3, 0.8);
  const double b = any_double(0.05, 0.3);
  switch (*rc::gen::inRange(0, 10)) {
    case 0:
      return Box{.size = any_vector(0.1, 1)};
    case 1:
      return Sphere{.radius = a};
    case 2:
      return Cylinder{.radius = a, .height = b};
    case 3:
      return Cone{.radius_bottom = a, .radius_top = *rc::gen::arbitrary<bool>() ? b : 0.0, .height = a};
    case 4:
      return Torus{.major_radius = a, .minor_radius = b};
    case 5:
      return HalfSpace{};
    case 6:
      return Polytope{
          .planes = {{{-1, 0, 0}, a}, {{0, -1, 0}, b}, {{0, 0, -1}, a}, {{0.6, 0.8, 0}, a}, {{0, 0, 1}, b}}};
    case 7:
      return Extrusion{.profile = any_profile(any_double), .height = b};
    case 8:
      return any_revolution(any_double);
    default: {
      const Eigen::Vector3d low = any_vector(-0.6, -0.5);
      return Expression{.distance = "sqrt(x^2 + y^2 + 2 * z^2) - 0.5", .bounds = AlignedBox(low, any_vector(0.5, 0.6))};
    }
  }
}

}  // namespace cloud2csg::test
