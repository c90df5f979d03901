#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cloud2csg/advanced/rank_classes.hpp"
#include "core/fields/block_field.hpp"
#include "paper/objective/contribution_units.hpp"

/// The vectorised inner loop of the point pass: a primitive's contributions at a block. Uses only operations that IEEE
/// 754 defines to the bit, in one order, so that all instruction sets agree. `Real` is double or float.
namespace cloud2csg {

/// Contributions in units, one for each point of a block.
using Units = std::array<std::uint32_t, k_block_points>;

/// A primitive's contributions at a block, plain and complemented (with the opposite gradient).
struct BlockUnits {
  alignas(64) Units plain{}, complement{};
};

struct alignas(64) PackedPairs {
  std::array<std::array<PackedContribution, 2>, k_block_points> of;
};

/// What a primitive contributes to E(t) at the points of a block if it is the selected one.
template <class Real>
struct BlockContributions {
  BlockUnits units;
  bool is_silent = true;  ///< all contributions are zero
  BlockMask member{};     ///< points that belong to the primitive
  BlockMask inside{};     ///< points with a negative distance
  /// Bounds of |distance| at all k_block_points.
  Real smallest = 0, largest = 0;
};

struct ContributionParameters {
  double beta;
  double gamma;
  SegmentationTolerances tolerances;
  bool unit_gradient;  ///< gradients have length one: no need to measure
};

/// Whether a surface seen from its far side, at least 90 degrees off, counts at all: only with a very forgiving gamma.
[[nodiscard]] constexpr bool far_side_counts(double gamma) {
  constexpr double k_right_angle_square = 2.4674;
  return gamma * gamma * k_right_angle_square < 20.0;  // exp(-20) rounds to zero
}

/// Contributions are whole units, so that their sums are exact in any order. `member` and `inside` cover all
/// k_block_points entries; mask off the padding.
void compute_contributions(const BlockField<double>& field, const BlockNormals<double>& normals,
                           const ContributionParameters& parameters, BlockContributions<double>& out);
void compute_contributions(const BlockField<float>& field, const BlockNormals<float>& normals,
                           const ContributionParameters& parameters, BlockContributions<float>& out);

void interleave(const BlockUnits& first, const BlockUnits& second, PackedPairs& out);

}  // namespace cloud2csg
