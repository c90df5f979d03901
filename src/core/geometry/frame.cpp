#include "core/geometry/frame.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace cloud2csg {

Eigen::Vector3d frame_origin(const Points& points) {
  const AlignedBox box = bounds_of(points);
  const double diagonal = box.diagonal().norm();
  if (points.empty() || !std::isfinite(diagonal) || !box.center().allFinite()) return Eigen::Vector3d::Zero();
  int exponent = 0;
  std::frexp(diagonal, &exponent);
  const double step = std::ldexp(1.0, exponent);
  return (box.center() / step).array().round() * step;
}

PointCloud seen_from(PointCloud cloud, const Eigen::Vector3d& origin) {
  for (Points* const points : {&cloud.positions, &cloud.sensor_positions}) {
    const std::array<std::vector<double>*, 3> axes{&points->x, &points->y, &points->z};
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      for (double& value : *axes[axis]) value -= origin[static_cast<Eigen::Index>(axis)];
    }
  }
  return cloud;
}

}  // namespace cloud2csg
