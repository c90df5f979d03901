#pragma once

#include "cloud2csg/advanced/segmentation.hpp"
#include "core/fields/block_field.hpp"

namespace cloud2csg {

/// Below this share of the tolerance, a distance leaves a point's side open. Above, up to it, the side is likely.
inline constexpr double k_open_share = 1.0 / 3.0;

/// On which side of a primitive a block's points are, and whether they are on its surface. One bit a point.
struct BlockSides {
  BlockMask inside{};   ///< with a negative distance
  BlockMask near{};     ///< within the tolerance
  BlockMask open{};     ///< within k_open_share of the tolerance
  BlockMask along{};    ///< on the surface, the normal along the gradient
  BlockMask against{};  ///< on the surface, the normal against the gradient
};

/// Covers all k_block_points entries; mask off the padding. Normals have unit length. `Real` is double or float. Uses
/// only operations that IEEE 754 defines to the bit, in one order: all instruction sets agree.
void compute_sides(const BlockField<double>& field, const BlockNormals<double>& normals,
                   const SegmentationTolerances& tolerances, BlockSides& out);
void compute_sides(const BlockField<float>& field, const BlockNormals<float>& normals,
                   const SegmentationTolerances& tolerances, BlockSides& out);

}  // namespace cloud2csg
