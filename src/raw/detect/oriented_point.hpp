#pragma once

#include <Eigen/Core>

namespace cloud2csg {

struct OrientedPoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  ///< unit length, outward
};

}  // namespace cloud2csg
