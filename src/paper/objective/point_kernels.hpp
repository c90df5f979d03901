#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cloud2csg/advanced/rank_classes.hpp"
#include "core/fields/block_field.hpp"
#include "paper/objective/contribution_units.hpp"

/// The vectorised inner loop of the pass over the points: what one primitive contributes at each point of a block. Only
/// operations that IEEE 754 defines to the bit are used, in one order, so that every instruction set gives the same
/// result. `Real` is double or float.
namespace cloud2csg {

/// Units of contributions, a point of a block each.
using Units = std::array<std::uint32_t, k_block_points>;

/// What a primitive contributes at the points of a block, as it is and as its complement, with the opposite gradient.
struct BlockUnits {
  alignas(64) Units plain{}, complement{};
};

/// What two primitives contribute at the points of a block.
struct alignas(64) PackedPairs {
  std::array<std::array<PackedContribution, 2>, k_block_points> of;
};

/// What a primitive contributes to E(t) at the points of a block, were it the selected one.
template <class Real>
struct BlockContributions {
  BlockUnits units;
  bool is_silent = true;  ///< all of them are zero
  BlockMask member{};     ///< points that belong to the primitive
  BlockMask inside{};     ///< points with a negative distance
  /// Of all k_block_points: no |distance| is outside.
  Real smallest = 0, largest = 0;
};

struct ContributionParameters {
  double beta;
  double gamma;
  SegmentationTolerances tolerances;
  bool unit_gradient;  ///< gradients have length one: no need to measure it
};

/// Whether a surface seen from its far side, at least 90 degrees off, counts at all: only for a very forgiving gamma.
[[nodiscard]] constexpr bool far_side_counts(double gamma) {
  constexpr double k_right_angle_square = 2.4674;
  return gamma * gamma * k_right_angle_square < 20.0;  // exp(-20) rounds to zero
}

/// Contributions are rounded to whole units, so that their sums are exact, whatever the order. `member` and `inside`
/// are computed for all k_block_points entries; mask off the padding.
void compute_contributions(const BlockField<double>& field, const BlockNormals<double>& normals,
                           const ContributionParameters& parameters, BlockContributions<double>& out);
void compute_contributions(const BlockField<float>& field, const BlockNormals<float>& normals,
                           const ContributionParameters& parameters, BlockContributions<float>& out);

/// Packs what two primitives contribute.
void interleave(const BlockUnits& first, const BlockUnits& second, PackedPairs& out);

}  // namespace cloud2csg
