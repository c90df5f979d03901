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
[[nodiscard]] SampledField sample_field(const Primitive& primitive, PointsView points);

}  // namespace cloud2csg
