#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <memory>

#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/primitive.hpp"
#include "core/fields/block_field.hpp"

/// Blocks of points, and the frame in which their distances are computed: its origin is among them where numbers are
/// short.
namespace cloud2csg {

/// Whether distances in single precision, in a frame whose origin is in the middle of the points' bounds, are good
/// enough for points with such noise: rounding is then a five-thousandth of it. O(primitives)
[[nodiscard]] bool is_single_enough(const AlignedBox& points, const PrimitiveSet& primitives, double noise);

/// Moves the primitives to the frame with that origin. `Real` is what they will be evaluated in: for floats, plain
/// half-spaces are also moved along their planes, so that their poses are near.
template <class Real>
void move_to_frame(PrimitiveSet& primitives, const Eigen::Vector3d& origin);

extern template void move_to_frame<double>(PrimitiveSet&, const Eigen::Vector3d&);
extern template void move_to_frame<float>(PrimitiveSet&, const Eigen::Vector3d&);

/// Points a chunk: what is kept of them in any precision stays in the second-level cache.
inline constexpr std::size_t k_chunk_points = 16384;

/// How many chunks a cloud has.
[[nodiscard]] inline std::size_t chunk_count(std::size_t points) {
  return (points + k_chunk_points - 1) / k_chunk_points;
}

/// One chunk of a cloud after the other, its points in the order of a space-filling curve and cut into blocks: the
/// points of a block are near each other, so that much of what is computed of them is alike. One a thread.
/// `Real` is double or float.
template <class Real>
class PointBlocks {
 public:
  /// `box` is the cloud's bounds; `order` all its indices, see spatial_order(). Precondition: the cloud has normals;
  /// it and the order outlive this.
  PointBlocks(const PointCloud& cloud, const AlignedBox& box, std::span<const std::uint32_t> order);

  /// Coordinates are relative to it: for doubles it is zero, so that nothing is rounded.
  [[nodiscard]] static Eigen::Vector3d origin(const AlignedBox& box);

  /// Turns to chunk 0 .. chunk_count() - 1. O(points of the chunk).
  void load(std::size_t chunk);

  /// Blocks of the chunk.
  [[nodiscard]] std::size_t count() const { return (points_ + k_block_points - 1) / k_block_points; }
  /// Points of a block: k_block_points of all but the last.
  [[nodiscard]] std::size_t size(std::size_t block) const {
    return std::min(k_block_points, points_ - block * k_block_points);
  }
  /// k_block_points entries; those past the block's size repeat the last point.
  [[nodiscard]] BasicPointsView<Real> positions(std::size_t block) const {
    return {column(0, block), column(1, block), column(2, block)};
  }
  /// Bounds of a block's points, and of the whole chunk's, relative to the origin.
  [[nodiscard]] AlignedBox bounds(std::size_t block) const;
  [[nodiscard]] AlignedBox bounds() const;
  [[nodiscard]] BlockNormals<Real> normals(std::size_t block) const {
    return {column(3, block).data(), column(4, block).data(), column(5, block).data()};
  }

 private:
  struct alignas(64) Column {
    std::array<Real, k_chunk_points> values{};
  };
  [[nodiscard]] std::span<const Real> column(std::size_t which, std::size_t block) const {
    return std::span((*columns_)[which].values).subspan(block * k_block_points, k_block_points);
  }
  void take_column(std::size_t which, const std::vector<double>& from, double origin);

  const PointCloud* cloud_;
  std::span<const std::uint32_t> order_;
  Eigen::Vector3d origin_;
  std::size_t begin_ = 0;                           // the chunk's place in the order
  std::size_t points_ = 0;                          // of the chunk
  std::unique_ptr<std::array<Column, 6>> columns_;  ///< coordinates, then normals
};

extern template class PointBlocks<double>;
extern template class PointBlocks<float>;

}  // namespace cloud2csg
