#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "cloud2csg/primitive.hpp"

/// Blocks of points: sets of their points and values computed for a whole block. `Real` is double or float.
namespace cloud2csg {

/// Points a block. A multiple of 64. The columns of some 20 primitives stay in the second-level cache.
inline constexpr std::size_t k_block_points = 256;

/// One bit for each point of a block.
using BlockMask = std::array<std::uint64_t, k_block_points / 64>;

template <class Operation>
[[nodiscard]] BlockMask combine(const BlockMask& a, const BlockMask& b, const Operation& operation) {
  BlockMask result{};
  for (std::size_t w = 0; w < result.size(); ++w) result[w] = operation(a[w], b[w]);
  return result;
}
[[nodiscard]] inline BlockMask both(const BlockMask& a, const BlockMask& b) {
  return combine(a, b, [](std::uint64_t x, std::uint64_t y) { return x & y; });
}
[[nodiscard]] inline BlockMask either(const BlockMask& a, const BlockMask& b) {
  return combine(a, b, [](std::uint64_t x, std::uint64_t y) { return x | y; });
}
/// The points of `a` that are not in `b`.
[[nodiscard]] inline BlockMask without(const BlockMask& a, const BlockMask& b) {
  return combine(a, b, [](std::uint64_t x, std::uint64_t y) { return x & ~y; });
}

[[nodiscard]] inline bool is_empty(const BlockMask& mask) {
  return std::ranges::all_of(mask, [](std::uint64_t word) { return word == 0; });
}
[[nodiscard]] inline std::size_t point_count(const BlockMask& mask) {
  std::size_t count = 0;
  for (const std::uint64_t word : mask) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

/// How many aligned groups of eight points have a point in the set.
[[nodiscard]] inline std::size_t byte_count(const BlockMask& mask) {
  std::size_t count = 0;
  for (std::uint64_t word : mask) {
    for (int shift = 4; shift > 0; shift /= 2) word |= word >> shift;  // into the lowest bit of each byte
    count += static_cast<std::size_t>(std::popcount(word & 0x0101'0101'0101'0101U));
  }
  return count;
}

[[nodiscard]] inline bool has_point(const BlockMask& mask, std::size_t i) {
  return (mask[i / 64] >> (i % 64) & 1U) != 0;
}
inline void add_point(BlockMask& mask, std::size_t i) {
  mask[i / 64] |= std::uint64_t{1} << (i % 64);
}
inline void remove_point(BlockMask& mask, std::size_t i) {
  mask[i / 64] &= ~(std::uint64_t{1} << (i % 64));
}

/// Points 0 .. count - 1.
[[nodiscard]] inline BlockMask first_points(std::size_t count) {
  BlockMask mask{};
  for (std::size_t w = 0; w < mask.size(); ++w) {
    const std::size_t bits = count > 64 * w ? std::min<std::size_t>(count - 64 * w, 64) : 0;
    mask[w] = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  }
  return mask;
}

/// The unit normals of a block. Entries past the block's end may be anything finite.
template <class Real>
struct BlockNormals {
  const Real *x, *y, *z;  ///< k_block_points each, aligned to 64 bytes
};

template <class Real>
struct BlockField {
  alignas(64) std::array<Real, k_block_points> distance{}, gradient_x{}, gradient_y{}, gradient_z{};
};

template <class Real>
[[nodiscard]] BasicFieldSpans<Real> spans_of(BlockField<Real>& field) {
  return {.distance = field.distance,
          .gradient_x = field.gradient_x,
          .gradient_y = field.gradient_y,
          .gradient_z = field.gradient_z};
}

}  // namespace cloud2csg
