#pragma once

#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

inline void append(Points& points, const Points& more) {
  points.x.insert(points.x.end(), more.x.begin(), more.x.end());
  points.y.insert(points.y.end(), more.y.begin(), more.y.end());
  points.z.insert(points.z.end(), more.z.begin(), more.z.end());
}

/// Precondition: both know the same of their points, or `cloud` is empty. O(more)
inline void append(PointCloud& cloud, const PointCloud& more) {
  append(cloud.positions, more.positions);
  append(cloud.normals, more.normals);
  append(cloud.sensor_positions, more.sensor_positions);
}

}  // namespace cloud2csg
