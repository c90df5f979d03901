#pragma once

#include <cmath>
#include <string>

#include "cloud2csg/primitive.hpp"
#include "core/base/random.hpp"
#include "core/primitive/shape.hpp"
#include "support/any_profile.hpp"

/// Random solids for the tests of the overlap stage.
namespace cloud2csg::test {

inline Eigen::Vector3d random_vector(RandomStream& random, double low, double high) {
  return {random.uniform(low, high), random.uniform(low, high), random.uniform(low, high)};
}

inline Eigen::Vector3d random_direction(RandomStream& random) {
  return Eigen::Vector3d{random.normal(), random.normal(), random.normal()}.normalized();
}

inline Eigen::Quaterniond random_orientation(RandomStream& random) {
  return Eigen::Quaterniond{random.normal(), random.normal(), random.normal(), random.normal()}.normalized();
}

/// An octahedron with its corners cut off: eight planes and six.
inline Polytope random_polytope(RandomStream& random) {
  const double size = random.uniform(0.1, 0.5);
  const double cut = random.uniform(0.7, 1.5) * size;
  Polytope polytope;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d normal((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
    polytope.planes.push_back({.normal = normal / std::sqrt(3.0), .offset = size});
  }
  for (int axis = 0; axis < 3; ++axis) {
    polytope.planes.push_back({.normal = Eigen::Vector3d::Unit(axis), .offset = cut});
    polytope.planes.push_back({.normal = -Eigen::Vector3d::Unit(axis), .offset = cut});
  }
  return polytope;
}

inline Shape random_convex_shape(RandomStream& random) {
  switch (random.below(5)) {
    case 0:
      return Box{.size = random_vector(random, 0.1, 1.0)};
    case 1:
      return Sphere{.radius = random.uniform(0.1, 0.6)};
    case 2:
      return Cylinder{.radius = random.uniform(0.1, 0.5), .height = random.uniform(0.1, 1.2)};
    case 3:
      return Cone{.radius_bottom = random.uniform(0.1, 0.5),
                  .radius_top = random.chance(0.5) ? 0.0 : random.uniform(0.05, 0.5),
                  .height = random.uniform(0.1, 1.0)};
    default:
      return random_polytope(random);
  }
}

inline Primitive placed(const Shape& shape, RandomStream& random) {
  return {.id = "p",
          .shape = shape,
          .pose = {.position = random_vector(random, -0.8, 0.8), .orientation = random_orientation(random)}};
}

inline Primitive random_convex(RandomStream& random) {
  return placed(random_convex_shape(random), random);
}

/// Any bounded solid.
inline Primitive random_solid(RandomStream& random) {
  const double kind = random.uniform();
  if (kind < 0.2) {
    const double minor = random.uniform(0.05, 0.2);
    return placed(Torus{.major_radius = minor + random.uniform(0.05, 0.4), .minor_radius = minor}, random);
  }
  if (kind < 0.3) {
    return placed(Expression{.distance = "x^2 + y^2 + z^2 - 0.16",
                             .bounds = {Eigen::Vector3d::Constant(-0.4), Eigen::Vector3d::Constant(0.4)}},
                  random);
  }
  if (kind < 0.5) {
    const auto draw = [&random](double low, double high) { return random.uniform(low, high); };
    const Shape shape = random.chance(0.5) ? Shape(Extrusion{.profile = any_profile(draw), .height = draw(0.2, 2.0)})
                                           : Shape(any_revolution(draw));
    return placed(scaled(shape, random.uniform(0.1, 0.5)), random);
  }
  Primitive solid = random_convex(random);
  if (kind < 0.6) solid.displacement = Displacement{.frequency = random.uniform(1.0, 3.0)};
  return solid;
}

}  // namespace cloud2csg::test
