#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "paper/objective/rank_kernels.hpp"

namespace cloud2csg {

/// The points of a block grouped by key: neighbours have few different ones, so that what is looked up and added in a
/// large table is first gathered here, in the first-level cache.
class BlockGroups {
 public:
  /// `points` are places in the block, ascending. O(points).
  void group(const BlockKeys& keys, std::span<const std::uint16_t> points);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// By group: the first of its points, ascending.
  [[nodiscard]] std::span<const std::uint16_t> first_points() const { return std::span(first_points_).first(size_); }
  /// How many points the group has.
  [[nodiscard]] std::uint32_t count(std::size_t group) const { return counts_[group]; }
  /// The group of points[k].
  [[nodiscard]] std::size_t group_of(std::size_t k) const { return groups_[k]; }

 private:
  /// The slot of the key of a point: the one where it is, or a free one.
  [[nodiscard]] std::size_t slot_of(const BlockKeys& keys, std::uint16_t point) const;

  std::array<std::uint16_t, 2 * k_block_points> slots_{};  // group + 1; 0 is free
  std::array<std::uint16_t, k_block_points> first_points_{}, counts_{}, groups_{};
  std::size_t size_ = 0;
};

}  // namespace cloud2csg
