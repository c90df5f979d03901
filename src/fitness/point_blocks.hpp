#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <memory>

#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/rank_classes.hpp"
#include "fitness/point_kernels.hpp"

namespace cloud2csg {

/// The points of a cloud in the order of a space-filling curve (Morton's), cut into blocks: the points of a block are
/// neighbours, so that most of what is computed of them is alike. `Real` is double or float.
template <class Real>
class PointBlocks {
 public:
  /// `box` is the cloud's bounds. Precondition: the cloud has normals and at least one point. O(points).
  /// @throws Cancelled
  PointBlocks(const PointCloud& cloud, const AlignedBox& box, const RunContext& run);

  /// Coordinates of the blocks are relative to it: for doubles it is zero, so that nothing is rounded.
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  [[nodiscard]] std::size_t count() const { return (points_ + k_block_points - 1) / k_block_points; }
  /// Points of a block: k_block_points of all but the last.
  [[nodiscard]] std::size_t size(std::size_t block) const {
    return std::min(k_block_points, points_ - block * k_block_points);
  }
  /// k_block_points entries; those past the block's size repeat the cloud's last point.
  [[nodiscard]] BasicPointsView<Real> positions(std::size_t block) const {
    return {columns_[0][block].values, columns_[1][block].values, columns_[2][block].values};
  }
  [[nodiscard]] BlockNormals<Real> normals(std::size_t block) const {
    return {columns_[3][block].values.data(), columns_[4][block].values.data(), columns_[5][block].values.data()};
  }

 private:
  struct alignas(64) Column {
    std::array<Real, k_block_points> values;
  };
  [[nodiscard]] Real& at(std::size_t column, std::size_t place) {
    return columns_[column][place / k_block_points].values[place % k_block_points];
  }

  std::size_t points_;
  Eigen::Vector3d origin_;
  /// Coordinates, then normals. Not vectors, which would be filled with zeros first.
  std::array<std::unique_ptr<Column[]>, 6> columns_;
};

extern template class PointBlocks<double>;
extern template class PointBlocks<float>;

}  // namespace cloud2csg
