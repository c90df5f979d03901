#pragma once

#include <limits>
#include <utility>

#include "cloud2csg/geometry.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {

[[nodiscard]] inline AlignedBox everywhere() {
  const Eigen::Vector3d corner = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  return {-corner, corner};
}

/// The box with `margin` added on each side. Precondition: the box is not empty.
[[nodiscard]] inline AlignedBox grown(const AlignedBox& box, double margin) {
  return {box.min().array() - margin, box.max().array() + margin};
}

/// Least and greatest coordinate of the box along an axis from `origin`; `axis` has unit length.
[[nodiscard]] inline std::pair<double, double> extent_along(const AlignedBox& box, const Eigen::Vector3d& origin,
                                                            const Eigen::Vector3d& axis) {
  const double middle = (box.center() - origin).dot(axis);
  const double half = 0.5 * box.sizes().dot(axis.cwiseAbs());
  return {middle - half, middle + half};
}

/// Whether no side is at infinity.
[[nodiscard]] inline bool is_finite(const AlignedBox& box) {
  return box.min().allFinite() && box.max().allFinite();
}

/// A place whose coordinates are uniform between those of the corners. Draws x first.
[[nodiscard]] inline Eigen::Vector3d random_between(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                                    RandomStream& random) {
  Eigen::Vector3d result;
  for (int axis = 0; axis < 3; ++axis) result[axis] = random.uniform(low[axis], high[axis]);
  return result;
}

}  // namespace cloud2csg
