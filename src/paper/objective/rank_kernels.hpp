#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "paper/objective/point_kernels.hpp"

/// The order of several primitives at each point of a block, and keys made from it.
namespace cloud2csg {

/// A primitive's signed ranks at the points of a block.
struct alignas(64) RankColumn {
  std::array<std::int8_t, k_block_points> ranks;
};

/// A primitive's distances at a block of points, and bounds of their magnitudes.
template <class Real>
struct DistanceColumn {
  const Real* distances;  ///< k_block_points, aligned to 64 bytes
  Real smallest, largest;
};

/// Signed ranks of up to RankClasses::k_byte_limit primitives at each point of a block. Compares primitives point by
/// point only where the bounds leave their order open. `Real` is double or float.
void compute_signed_ranks(std::span<const DistanceColumn<double>> primitives, std::span<RankColumn> out);
void compute_signed_ranks(std::span<const DistanceColumn<float>> primitives, std::span<RankColumn> out);
/// The signed ranks of some primitives among themselves, from those among more.
void compute_signed_ranks(std::span<const RankColumn* const> primitives, std::span<RankColumn> out);

/// How a key packs signed ranks: each code is n + signed rank, `bits` wide, codes_per_word to a word.
struct KeyLayout {
  explicit KeyLayout(std::size_t primitives);
  std::uint32_t bits;
  std::uint32_t codes_per_word;
  std::size_t words;

  [[nodiscard]] std::uint32_t word_of(std::size_t primitive) const {
    return static_cast<std::uint32_t>(primitive) / codes_per_word;
  }
  [[nodiscard]] std::uint32_t shift_of(std::size_t primitive) const {
    return static_cast<std::uint32_t>(primitive) % codes_per_word * bits;
  }

  /// Where a primitive's code is in a key, worked out once for many keys.
  struct Place {
    std::uint32_t word, shift, mask;
    [[nodiscard]] std::uint32_t code_in(std::span<const std::uint32_t> key) const { return key[word] >> shift & mask; }
  };
  [[nodiscard]] Place place_of(std::size_t primitive) const {
    return {word_of(primitive), shift_of(primitive), (std::uint32_t{1} << bits) - 1};
  }
};

struct BlockKeys {
  explicit BlockKeys(std::size_t key_words = 0) { reshape(key_words); }

  /// Sets the words of a key. The contents are lost.
  void reshape(std::size_t key_words) {
    count = key_words;
    words.resize(std::max(words.size(), key_words * k_block_points));
  }

  std::size_t count = 0;                                           ///< words of a key
  AlignedVector<std::uint32_t> words;                              ///< word w of point i at [w * k_block_points + i]
  alignas(64) std::array<std::uint32_t, k_block_points> hashes{};  ///< hash of all words
};

/// Writes the words that the layout has.
void pack_rank_keys(std::span<const RankColumn> columns, const KeyLayout& layout, BlockKeys& keys);
/// Writes the last word: the primitives that a point belongs to, bit k for the k-th of at most 32 masks.
void pack_member_word(std::span<const BlockMask* const> members, BlockKeys& keys);
/// Precondition: all words are written.
void compute_hashes(BlockKeys& keys);

/// Ranks by sorting at each point, and keys of them: for many primitives, and as the reference of the functions above.
void sort_rank_keys(std::span<const double* const> distances, const KeyLayout& layout, BlockKeys& keys);
void sort_rank_keys(std::span<const float* const> distances, const KeyLayout& layout, BlockKeys& keys);

}  // namespace cloud2csg
