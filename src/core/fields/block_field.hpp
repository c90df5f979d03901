#pragma once

#include <array>

#include "cloud2csg/primitive.hpp"
#include "core/fields/block_mask.hpp"

/// What is computed of a block of points at once. `Real` is double or float.
namespace cloud2csg {

/// The unit normals of a block of points; entries past the block's end may be anything finite.
template <class Real>
struct BlockNormals {
  const Real *x, *y, *z;  ///< k_block_points each, aligned to 64 bytes
};

/// A primitive's field at a block of points.
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
