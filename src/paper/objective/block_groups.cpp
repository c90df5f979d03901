#include "paper/objective/block_groups.hpp"

#include <bit>

namespace cloud2csg {
namespace {

bool equal(const BlockKeys& keys, std::size_t a, std::size_t b) {
  for (std::size_t w = 0; w < keys.count; ++w) {
    if (keys.words[w * k_block_points + a] != keys.words[w * k_block_points + b]) return false;
  }
  return true;
}

}  // namespace

std::size_t BlockGroups::slot_of(const BlockKeys& keys, std::uint16_t point) const {
  static_assert(std::has_single_bit(2 * k_block_points));
  constexpr std::size_t k_mask = 2 * k_block_points - 1;
  std::size_t slot = keys.hashes[point] & k_mask;
  while (slots_[slot] != 0 && !equal(keys, first_points_[slots_[slot] - 1U], point)) slot = (slot + 1) & k_mask;
  return slot;
}

void BlockGroups::group(const BlockKeys& keys, std::span<const std::uint16_t> points) {
  slots_.fill(0);
  size_ = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t slot = slot_of(keys, points[k]);
    if (slots_[slot] == 0) {
      first_points_[size_] = points[k];
      counts_[size_] = 0;
      slots_[slot] = static_cast<std::uint16_t>(++size_);
    }
    groups_[k] = static_cast<std::uint16_t>(slots_[slot] - 1U);
    ++counts_[groups_[k]];
  }
}

}  // namespace cloud2csg
