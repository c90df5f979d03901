#pragma once

#include <fmt/format.h>

#include <cmath>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "core/base/random.hpp"

namespace cloud2csg::bench {

/// A unit vector, uniform over the sphere.
inline Eigen::Vector3d random_direction(RandomStream& random) {
  return Eigen::Vector3d{random.normal(), random.normal(), random.normal()}.normalized();
}

/// Random boxes, cylinders and spheres in a cube that grows with their number: constant degree of the overlap graph.
inline PrimitiveSet random_solids(std::size_t count, double solids_a_unit) {
  RandomStream random(count);
  const double half_side = 0.5 * std::cbrt(static_cast<double>(count) / solids_a_unit);
  PrimitiveSet solids;
  for (std::size_t i = 0; i < count; ++i) {
    const auto size = [&random] { return random.uniform(0.5, 1.0); };
    const Shape shape = i % 3 == 0   ? Shape(Box{.size = {size(), size(), size()}})
                        : i % 3 == 1 ? Shape(Cylinder{.radius = 0.5 * size(), .height = size()})
                                     : Shape(Sphere{.radius = 0.5 * size()});
    const auto coordinate = [&] { return random.uniform(-half_side, half_side); };
    solids.push_back(
        {.id = fmt::format("p{}", i),
         .shape = shape,
         .pose = {
             .position = {coordinate(), coordinate(), coordinate()},
             .orientation =
                 Eigen::Quaterniond{random.normal(), random.normal(), random.normal(), random.normal()}.normalized()}});
  }
  return solids;
}

}  // namespace cloud2csg::bench
