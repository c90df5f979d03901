#pragma once

#include "cloud2csg/advanced/segmentation.hpp"
#include "core/fields/block_field.hpp"

namespace cloud2csg {

/// Distances below this share of the tolerance leave it open on which side a point is; those above, up to the
/// tolerance, make it likely.
inline constexpr double k_open_share = 1.0 / 3.0;

/// On which side of a primitive the points of a block are, and whether they are on its surface. One bit a point.
struct BlockSides {
  BlockMask inside{};   ///< with a negative distance
  BlockMask near{};     ///< not farther than the tolerance
  BlockMask open{};     ///< not farther than k_open_share of it
  BlockMask along{};    ///< on the surface, the normal along the gradient
  BlockMask against{};  ///< on the surface, the normal against the gradient
};

/// All k_block_points entries; mask off the padding. Normals are of unit length. `Real` is double or float. Only
/// operations that IEEE 754 defines to the bit are used, in one order: every instruction set gives the same result.
void compute_sides(const BlockField<double>& field, const BlockNormals<double>& normals,
                   const SegmentationTolerances& tolerances, BlockSides& out);
void compute_sides(const BlockField<float>& field, const BlockNormals<float>& normals,
                   const SegmentationTolerances& tolerances, BlockSides& out);

}  // namespace cloud2csg
