#pragma once

#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// A primitive's field at some points.
struct SampledField {
  std::vector<double> distances;
  Points slopes;

  /// From the surface to the point, were the field linear: what a step of Newton's takes from it. Precondition: there
  /// is a slope.
  [[nodiscard]] Eigen::Vector3d offset(std::size_t point) const {
    const Eigen::Vector3d slope = slopes[point];
    return distances[point] / slope.squaredNorm() * slope;
  }
};

/// See evaluate_field().
[[nodiscard]] inline SampledField sample_field(const Primitive& primitive, PointsView points) {
  SampledField field{.distances = std::vector<double>(points.size()), .slopes = Points(points.size())};
  evaluate_field(primitive, points,
                 {.distance = field.distances,
                  .gradient_x = field.slopes.x,
                  .gradient_y = field.slopes.y,
                  .gradient_z = field.slopes.z});
  return field;
}

}  // namespace cloud2csg
