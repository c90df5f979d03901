#include "cloud2csg/geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace cloud2csg {

Pose compose(const Pose& outer, const Pose& inner) {
  return {.position = outer.to_world(inner.position),
          .orientation = (outer.orientation * inner.orientation).normalized()};
}

Pose pose_from_axis(const Eigen::Vector3d& position, const Eigen::Vector3d& axis) {
  return {.position = position,
          .orientation = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).normalized()};
}

AlignedBox enclosing_box(const OrientedBox& box) {
  const Eigen::Matrix3d rotation = box.pose.orientation.toRotationMatrix();
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double weight = std::abs(rotation(row, column));
      // An infinite axis across the row has no extent: 0 * infinity, or a rounding error of 0 times infinity.
      const bool is_across = weight <= std::numeric_limits<double>::epsilon();
      if (!(is_across && std::isinf(box.half_size[column]))) half[row] += weight * box.half_size[column];
    }
  }
  return {box.pose.position - half, box.pose.position + half};
}

namespace {

/// Lowest and highest of some numbers. Works in lanes, because compilers do not vectorise a minimum of doubles.
std::pair<double, double> range_of(std::span<const double> numbers) {
  constexpr std::size_t k_lanes = 8;
  std::array<double, k_lanes> low;
  std::array<double, k_lanes> high;
  low.fill(numbers.front());
  high.fill(numbers.front());
  std::size_t i = 0;
  for (; i + k_lanes <= numbers.size(); i += k_lanes) {
    for (std::size_t lane = 0; lane < k_lanes; ++lane) {
      const double number = numbers[i + lane];
      low[lane] = number < low[lane] ? number : low[lane];
      high[lane] = number > high[lane] ? number : high[lane];
    }
  }
  for (; i < numbers.size(); ++i) {
    low[0] = std::min(low[0], numbers[i]);
    high[0] = std::max(high[0], numbers[i]);
  }
  return {*std::ranges::min_element(low), *std::ranges::max_element(high)};
}

}  // namespace

AlignedBox bounds_of(PointsView points) {
  AlignedBox box;
  if (points.empty()) return box;
  const auto [x_low, x_high] = range_of(points.x);
  const auto [y_low, y_high] = range_of(points.y);
  const auto [z_low, z_high] = range_of(points.z);
  return {Eigen::Vector3d(x_low, y_low, z_low), Eigen::Vector3d(x_high, y_high, z_high)};
}

}  // namespace cloud2csg
