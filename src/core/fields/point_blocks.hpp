#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <memory>

#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/primitive.hpp"
#include "core/fields/block_field.hpp"

/// Blocks of points, and the frame of their distances. In single precision, its origin is among the points.
namespace cloud2csg {

/// Whether single precision, in a frame around the middle of the points' bounds, suffices for points with this noise:
/// rounding is then a five-thousandth of the noise. O(primitives)
[[nodiscard]] bool is_single_enough(const AlignedBox& points, const PrimitiveSet& primitives, double noise);

/// Moves the primitives to the frame with this origin. `Real` is the type of their evaluation. For floats, plain
/// half-spaces also move along their planes, so that their poses are near.
template <class Real>
void move_to_frame(PrimitiveSet& primitives, const Eigen::Vector3d& origin);

extern template void move_to_frame<double>(PrimitiveSet&, const Eigen::Vector3d&);
extern template void move_to_frame<float>(PrimitiveSet&, const Eigen::Vector3d&);

/// Points a chunk. In any precision, their data stays in the second-level cache.
inline constexpr std::size_t k_chunk_points = 16384;

[[nodiscard]] inline std::size_t chunk_count(std::size_t points) {
  return (points + k_chunk_points - 1) / k_chunk_points;
}

/// A cloud's points chunk by chunk along a space-filling curve, cut into blocks of points near each other, so that
/// their computations are much alike. One for each thread. `Real` is double or float.
template <class Real>
class PointBlocks {
 public:
  /// `box` is the cloud's bounds; `order` holds all its indices, see spatial_order(). Precondition: the cloud has
  /// normals. It and the order outlive this.
  PointBlocks(const PointCloud& cloud, const AlignedBox& box, std::span<const std::uint32_t> order);

  /// The origin of coordinates. Zero for doubles, so that nothing is rounded.
  [[nodiscard]] static Eigen::Vector3d origin(const AlignedBox& box);

  /// Loads chunk 0 .. chunk_count() - 1. O(points of the chunk).
  void load(std::size_t chunk);

  /// Blocks of the chunk.
  [[nodiscard]] std::size_t count() const { return (points_ + k_block_points - 1) / k_block_points; }
  /// Points of a block: k_block_points in all but the last.
  [[nodiscard]] std::size_t size(std::size_t block) const {
    return std::min(k_block_points, points_ - block * k_block_points);
  }
  /// k_block_points entries; those past the block's size repeat the last point.
  [[nodiscard]] BasicPointsView<Real> positions(std::size_t block) const {
    return {column(0, block), column(1, block), column(2, block)};
  }
  /// Bounds of a block's points, and of the chunk's, relative to the origin.
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
  std::size_t begin_ = 0;                           // where the chunk begins in the order
  std::size_t points_ = 0;                          // in the chunk
  std::unique_ptr<std::array<Column, 6>> columns_;  ///< coordinates, then normals
};

extern template class PointBlocks<double>;
extern template class PointBlocks<float>;

}  // namespace cloud2csg
