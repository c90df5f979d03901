#pragma once

#include "cloud2csg/geometry.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {

/// Each coordinate between those of the corners, x first.
[[nodiscard]] inline Eigen::Vector3d random_between(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                                    RandomStream& random) {
  Eigen::Vector3d result;
  for (int axis = 0; axis < 3; ++axis) result[axis] = random.uniform(low[axis], high[axis]);
  return result;
}

}  // namespace cloud2csg
