#pragma once

#include <rapidcheck.h>

#include <numbers>
#include <string>
#include <vector>

#include "cloud2csg/primitive.hpp"
#include "support/any_profile.hpp"

/// Random solids for the property tests, about one to four units wide, near the origin.
namespace cloud2csg::testing {

/// From low to high - 1, evenly: RapidCheck by itself begins near the low end.
inline int integer(int low, int high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high));
}

inline double real(double low, double high) {
  return low + (high - low) * 1e-6 * integer(0, 1'000'001);
}

inline Eigen::Vector3d vector_within(double size) {
  return {real(-size, size), real(-size, size), real(-size, size)};
}

inline Eigen::Vector3d unit_vector() {
  const double z = real(-1, 1);
  const double angle = real(0, 2 * std::numbers::pi);
  const double across = std::sqrt(1 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

inline Pose any_pose() {
  return {.position = vector_within(2),
          .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(real(0.01, 3), unit_vector()))};
}

/// A cube less up to six slanted cuts.
inline Polytope any_polytope() {
  Polytope polytope;
  for (int axis = 0; axis < 3; ++axis) {
    polytope.planes.push_back({.normal = Eigen::Vector3d::Unit(axis), .offset = real(0.5, 1.5)});
    polytope.planes.push_back({.normal = -Eigen::Vector3d::Unit(axis), .offset = real(0.5, 1.5)});
  }
  for (int cuts = integer(0, 7); cuts > 0; --cuts) {
    polytope.planes.push_back({.normal = unit_vector(), .offset = real(0.4, 1.5)});
  }
  return polytope;
}

inline Cone any_cone() {
  switch (integer(0, 3)) {
    case 0:
      return {.radius_bottom = real(0.2, 2), .radius_top = 0, .height = real(0.2, 2)};
    case 1:
      return {.radius_bottom = 0, .radius_top = real(0.2, 2), .height = real(0.2, 2)};
    default:
      return {.radius_bottom = real(0.2, 2), .radius_top = real(0.2, 2), .height = real(0.2, 2)};
  }
}

inline Shape any_exact_shape() {
  switch (integer(0, 8)) {
    case 0:
      return Box{.size = {real(0.2, 2), real(0.2, 2), real(0.2, 2)}};
    case 1:
      return Sphere{.radius = real(0.2, 2)};
    case 2:
      return Cylinder{.radius = real(0.2, 2), .height = real(0.2, 3)};
    case 3:
      return any_cone();
    case 4: {
      const double major = real(0.4, 2);
      return Torus{.major_radius = major, .minor_radius = major * real(0.1, 1)};
    }
    case 5:
      return Extrusion{.profile = test::any_profile(real), .height = real(0.2, 2)};
    case 6:
      return test::any_revolution(real);
    default:
      return HalfSpace{};
  }
}

inline Shape any_analytic_shape() {
  if (integer(0, 7) == 0) return any_polytope();
  return any_exact_shape();
}

/// An ellipsoid; its value is no distance. The bounds leave room for a displacement.
inline Expression any_expression() {
  return {.distance = "sqrt(x^2 + (y / 1.5)^2 + (2 * z)^2) - 1",
          .bounds = AlignedBox(Eigen::Vector3d(-2, -3, -1), Eigen::Vector3d(2, 3, 1))};
}

inline Primitive any_exact_primitive() {
  return {.id = "p", .shape = any_exact_shape(), .pose = any_pose()};
}

/// Any shape, rotated or not, displaced or not.
inline Primitive any_primitive() {
  Primitive primitive{.id = "p", .shape = any_expression(), .pose = any_pose()};
  if (integer(0, 10) > 0) primitive.shape = any_analytic_shape();
  if (integer(0, 4) == 0) primitive.pose.orientation.setIdentity();
  if (integer(0, 4) == 0) primitive.displacement = Displacement{.frequency = real(0.5, 8)};
  return primitive;
}

/// A solid with ends that is convex.
inline Primitive any_convex_primitive() {
  Primitive primitive{.id = "p", .shape = any_polytope(), .pose = any_pose()};
  switch (integer(0, 5)) {
    case 0:
      primitive.shape = Box{.size = {real(0.2, 2), real(0.2, 2), real(0.2, 2)}};
      break;
    case 1:
      primitive.shape = Sphere{.radius = real(0.2, 2)};
      break;
    case 2:
      primitive.shape = Cylinder{.radius = real(0.2, 2), .height = real(0.2, 3)};
      break;
    case 3:
      primitive.shape = any_cone();
      break;
    default:
      break;
  }
  return primitive;
}

inline Points points_near(const Primitive& primitive, std::size_t count, double size = 3) {
  Points points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(primitive.pose.position + vector_within(size));
  return points;
}

inline Points single(const Eigen::Vector3d& point) {
  Points points;
  points.push_back(point);
  return points;
}

inline double distance_at(const Primitive& primitive, const Eigen::Vector3d& point) {
  return signed_distance(primitive, single(point))[0];
}

inline Eigen::Vector3d gradient_at(const Primitive& primitive, const Eigen::Vector3d& point) {
  return gradient(primitive, single(point))[0];
}

}  // namespace cloud2csg::testing
