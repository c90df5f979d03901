#pragma once

#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

struct SampledField {
  std::vector<double> distances;
  Points slopes;

  /// The vector from the surface if the field were linear (Newton's step). Precondition: the slope is not zero.
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
