#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cloud2csg/rank_classes.hpp"

/// The vectorised inner loops of the pass over the points: what one primitive contributes at each point of a block, and
/// the order of several primitives there. Only operations that IEEE 754 defines to the bit are used, in one order, so
/// that every instruction set gives the same result.
namespace cloud2csg {

/// Points a block. A multiple of 64; its columns for some 20 primitives stay in the second-level cache.
inline constexpr std::size_t k_block_points = 256;

/// One bit a point of a block.
using BlockMask = std::array<std::uint64_t, k_block_points / 64>;

/// The unit normals of a block of points, padded: entries past the block's end may be anything finite.
struct BlockNormals {
  alignas(64) std::array<double, k_block_points> x{}, y{}, z{};
};

/// A primitive's field at a block of points.
struct BlockField {
  alignas(64) std::array<double, k_block_points> distance{}, gradient_x{}, gradient_y{}, gradient_z{};
};

/// What a primitive contributes to E(t) at the points of a block, were it the selected one.
struct BlockContributions {
  /// In turn for each point: as it is, and as its complement, with the opposite gradient.
  alignas(64) std::array<float, 2 * k_block_points> pairs{};
  BlockMask member{};  ///< points that belong to the primitive
};

struct ContributionParameters {
  double beta;
  double gamma;
  SegmentationTolerances tolerances;
  bool unit_gradient;  ///< gradients have length one: no need to measure it
};

/// Contributions are rounded to multiples of 2^-22, so that their sums in double precision are exact, whatever the
/// order. `member` is computed for all k_block_points entries; mask off the padding.
void compute_contributions(const BlockField& field, const BlockNormals& normals,
                           const ContributionParameters& parameters, BlockContributions& out);

/// How signed ranks are packed into the words of a key: code = n + signed rank, `bits` wide, so many a word.
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
};

/// Signed ranks of the primitives at each point of a block as packed keys: word w of point i at keys[w * k_block_points
/// + i]. `distances` has one column of k_block_points a primitive. Compares all pairs: for up to some 127 primitives.
void compute_rank_keys(std::span<const double* const> distances, const KeyLayout& layout, std::uint64_t* keys);

/// The same by sorting at each point: for many primitives, and the reference of the one above.
void sort_rank_keys(std::span<const double* const> distances, const KeyLayout& layout, std::uint64_t* keys);

}  // namespace cloud2csg
