#pragma once

#include <array>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/primitive.hpp"
#include "core/base/random.hpp"
#include "support/any_profile.hpp"

/// Random solids, clouds and trees that are made to be awkward: equal solids, coinciding faces, points on faces, edges
/// and corners. All lies within some two units of the origin. Made from a RandomStream, because drawing each number
/// from RapidCheck would take most of the time; properties draw seeds and sizes.
namespace cloud2csg::test {

inline Eigen::Vector3d random_within(double size, RandomStream& random) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

inline Eigen::Vector3d random_direction(RandomStream& random) {
  const double z = random.uniform(-1, 1);
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  const double across = std::sqrt(1 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

/// A multiple of 1/4, so that faces coincide often and exactly.
inline double quarters(int low, int high, RandomStream& random) {
  return 0.25 * (low + static_cast<int>(random.below(static_cast<std::size_t>(high - low + 1))));
}

inline Pose random_pose(RandomStream& random) {
  Pose pose;
  const double x = quarters(-3, 3, random);
  const double y = quarters(-3, 3, random);
  pose.position = {x, y, quarters(-3, 3, random)};
  if (random.chance(0.4)) {
    const Eigen::Vector3d axis = random_direction(random);
    pose.orientation = Eigen::AngleAxisd(random.uniform(0.1, 3), axis);
  }
  return pose;
}

inline Shape random_shape(RandomStream& random) {
  const auto draw = [&random](double low, double high) { return random.uniform(low, high); };
  switch (random.below(11)) {
    case 0:
      return Sphere{.radius = quarters(1, 4, random)};
    case 1:
      return Cylinder{.radius = quarters(1, 3, random), .height = quarters(2, 6, random)};
    case 2:
      return Cone{.radius_bottom = quarters(1, 4, random), .radius_top = quarters(0, 2, random), .height = 1};
    case 3:
      return Torus{.major_radius = quarters(2, 4, random), .minor_radius = quarters(1, 2, random)};
    case 4:
      return HalfSpace{};
    case 5:
      return Extrusion{.profile = any_profile(draw), .height = quarters(1, 6, random)};
    case 6:
      return any_full_turn(draw);
    default: {
      const double x = quarters(1, 6, random);
      const double y = quarters(1, 6, random);
      return Box{.size = {x, y, quarters(1, 6, random)}};
    }
  }
}

/// An ellipsoid whose value is no distance.
inline Expression random_expression(RandomStream& random) {
  const AlignedBox bounds(Eigen::Vector3d::Constant(-1.5), Eigen::Vector3d::Constant(1.5));
  return random.chance(0.5) ? Expression{"sqrt(x^2 + (y / 1.5)^2 + (2 * z)^2) - 1", bounds}
                            : Expression{"x^2 + y^2 + z^2 - 1", bounds};
}

inline Primitive random_primitive(RandomStream& random) {
  Primitive primitive{.id = "p", .shape = random_shape(random), .pose = random_pose(random)};
  if (random.chance(0.05)) primitive.shape = random_expression(random);
  if (random.chance(0.1)) primitive.displacement = Displacement{.frequency = random.uniform(0.5, 6)};
  return primitive;
}

/// One in five is a copy of an earlier one, but for its id.
inline PrimitiveSet random_primitives(std::size_t count, RandomStream& random) {
  PrimitiveSet primitives;
  for (std::size_t p = 0; p < count; ++p) {
    const bool is_copy = p > 0 && random.chance(0.2);
    primitives.push_back(is_copy ? Primitive(primitives[random.below(p)]) : random_primitive(random));
    std::string id(1, 'p');
    id += std::to_string(p);
    primitives.back().id = std::move(id);
  }
  return primitives;
}

inline Points single(const Eigen::Vector3d& point) {
  Points points;
  points.push_back(point);
  return points;
}

/// Anywhere, on a lattice that holds faces, edges and corners exactly, or on (nearly: rounded) a solid's surface.
inline Eigen::Vector3d random_position(const PrimitiveSet& primitives, RandomStream& random) {
  switch (random.below(3)) {
    case 0:
      return random_within(1.5, random);
    case 1: {
      const double x = 0.5 * quarters(-8, 8, random);
      const double y = 0.5 * quarters(-8, 8, random);
      return {x, y, 0.5 * quarters(-8, 8, random)};
    }
    default: {
      const Primitive& primitive = primitives[random.below(primitives.size())];
      const Points start = single(random_within(1.5, random));
      return start[0] - signed_distance(primitive, start)[0] * gradient(primitive, start)[0];
    }
  }
}

/// Any direction, along an axis, or that of a solid's surface, from either side, exactly or nearly.
inline Eigen::Vector3d random_normal(const PrimitiveSet& primitives, const Eigen::Vector3d& at, RandomStream& random) {
  const double sign = random.chance(0.5) ? 1 : -1;
  switch (random.below(4)) {
    case 0:
      return random_direction(random);
    case 1:
      return sign * Eigen::Vector3d::Unit(random.below(3));
    default: {
      const Eigen::Vector3d exact = gradient(primitives[random.below(primitives.size())], single(at))[0].normalized();
      if (random.chance(0.5)) return sign * exact;
      return sign * (exact + random_within(0.3, random)).normalized();
    }
  }
}

inline PointCloud random_cloud(const PrimitiveSet& primitives, std::size_t count, RandomStream& random) {
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d position = random_position(primitives, random);
    cloud.positions.push_back(position);
    cloud.normals.push_back(random_normal(primitives, position, random));
  }
  return cloud;
}

/// A tree of all operations with `leaves` leaves out of 0 .. primitives - 1, each as often as it comes.
inline CsgTree random_formula(std::size_t primitives, std::size_t leaves, RandomStream& random) {
  CsgTree tree = CsgTree::leaf(random.below(primitives));
  if (leaves > 1) {
    const std::size_t on_the_left = 1 + random.below(leaves - 1);
    const CsgTree left = random_formula(primitives, on_the_left, random);
    const CsgTree right = random_formula(primitives, leaves - on_the_left, random);
    const std::uint32_t operation = random.below(3);
    tree = operation == 0 ? unite(left, right) : operation == 1 ? intersect(left, right) : subtract(left, right);
  }
  return random.chance(0.15) ? complement(tree) : tree;
}

}  // namespace cloud2csg::test
