#include "shape/compare/column_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cloud2csg {

ColumnGrid::ColumnGrid(const AlignedBox& box, int resolution) : centre_(box.center()) {
  const Eigen::Vector3d half = 0.5 * box.sizes();
  int depth_axis = 2;
  for (const int axis : {1, 0}) {
    if (half[axis] < half[depth_axis]) depth_axis = axis;
  }
  const int first_axis = (depth_axis + 1) % 3;
  const int second_axis = (depth_axis + 2) % 3;
  const double angle = std::atan(std::numbers::phi - 1.0);
  frame_.col(0) =
      std::cos(angle) * Eigen::Vector3d::Unit(first_axis) + std::sin(angle) * Eigen::Vector3d::Unit(second_axis);
  frame_.col(1) =
      -std::sin(angle) * Eigen::Vector3d::Unit(first_axis) + std::cos(angle) * Eigen::Vector3d::Unit(second_axis);
  frame_.col(2) = Eigen::Vector3d::Unit(depth_axis);

  // Treats a needle-like box as somewhat wider, to bound the lattice around it.
  constexpr double k_slimmest = 1.0 / 32.0;
  const double longest = half.maxCoeff();
  const double area =
      4.0 * std::max(half[first_axis], k_slimmest * longest) * std::max(half[second_axis], k_slimmest * longest);
  spacing_ = std::sqrt(area) / resolution;
  constexpr double k_room = 0.01;
  high_ = half[depth_axis] + k_room * longest;
  low_ = -high_;

  const Eigen::Vector2d reach(std::cos(angle) * half[first_axis] + std::sin(angle) * half[second_axis],
                              std::sin(angle) * half[first_axis] + std::cos(angle) * half[second_axis]);
  width_ = static_cast<std::int64_t>(2.0 * reach.x() / spacing_) + 2;
  height_ = static_cast<std::int64_t>(2.0 * reach.y() / spacing_) + 2;
  // Slight shifts keep nodes off the middle planes of symmetric parts.
  constexpr double k_shift_u = 0.5 - 0.0917;
  constexpr double k_shift_v = 0.5 + 0.0459;
  corner_ = -reach - spacing_ * Eigen::Vector2d(k_shift_u, k_shift_v);

  index_.assign(static_cast<std::size_t>(width_ * height_), k_no_column);
  for (std::int64_t j = 0; j < height_; ++j) {
    for (std::int64_t i = 0; i < width_; ++i) {
      const Eigen::Vector2d node = corner_ + spacing_ * Eigen::Vector2d(static_cast<double>(i), static_cast<double>(j));
      const Eigen::Vector3d offset = frame_ * Eigen::Vector3d(node.x(), node.y(), 0.0);
      if (std::abs(offset[first_axis]) > half[first_axis] || std::abs(offset[second_axis]) > half[second_axis]) {
        continue;
      }
      index_[static_cast<std::size_t>(j * width_ + i)] = static_cast<std::int32_t>(columns_.size());
      columns_.push_back(node);
    }
  }
}

Eigen::Vector3d ColumnGrid::to_lattice(const Eigen::Vector3d& world) const {
  const Eigen::Vector3d local = frame_.transpose() * (world - centre_);
  return {(local.x() - corner_.x()) / spacing_, (local.y() - corner_.y()) / spacing_, local.z()};
}

}  // namespace cloud2csg
