#pragma once

#include <cmath>

#include "cloud2csg/geometry.hpp"
#include "core/geometry/neighbour_tree.hpp"

namespace cloud2csg::test {

/// Each point and normal is a Gaussian mean of those around it, as in a mesh that joins the views of a scanner.
inline PointCloud smoothed(const PointCloud& cloud, double deviation) {
  const NeighbourTree tree(cloud.positions);
  PointCloud result = cloud;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double weights = 0;
    for (const std::uint32_t k : tree.within(cloud.positions[i], 3 * deviation)) {
      const double distance = (cloud.positions[k] - cloud.positions[i]).norm() / deviation;
      const double weight = std::exp(-0.5 * distance * distance);
      position += weight * cloud.positions[k];
      normal += weight * cloud.normals[k];
      weights += weight;
    }
    result.positions.set(i, position / weights);
    result.normals.set(i, normal.normalized());
  }
  return result;
}

}  // namespace cloud2csg::test
