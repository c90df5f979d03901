#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/random.hpp"
#include "raw/detect/work_cloud.hpp"

namespace cloud2csg {

/// The points that no surface has taken yet.
class FreePoints {
 public:
  explicit FreePoints(const WorkCloud& cloud);

  [[nodiscard]] const WorkCloud& cloud() const { return cloud_; }
  [[nodiscard]] const std::vector<std::uint32_t>& list() const { return list_; }  ///< ascending
  [[nodiscard]] const OrientedPoint& operator[](std::uint32_t i) const { return cloud_.points[i]; }

  /// O(n)
  void take(std::span<const std::uint32_t> points);

  /// So many drawn from all, with repetition; fewer when there are fewer.
  [[nodiscard]] std::vector<OrientedPoint> draw(std::size_t count, RandomStream& random) const;
  /// A random point, and others near it: out of the same cell of an octree, of random size. Up to `count`; the fewer,
  /// the less of the cell is free.
  [[nodiscard]] std::vector<OrientedPoint> draw_neighbours(std::size_t count, RandomStream& random) const;

 private:
  const WorkCloud& cloud_;
  std::vector<bool> is_free_;
  std::vector<std::uint32_t> list_;
};

}  // namespace cloud2csg
