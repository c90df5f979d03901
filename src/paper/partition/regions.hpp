#pragma once

#include <span>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// A part of space, and those of some primitives that reach into it.
struct Region {
  AlignedBox box;
  std::vector<PrimitiveIndex> near;  ///< ascending
};

/// Cuts space in two and in two again, until at most `limit` of the `primitives` (ascending) reach into each part, as
/// far as cuts can part them. `reach`: by primitive, boxes that may be infinite. The parts cover all of space, and
/// share only sides. O(n log n) for boxes of bounded overlap.
[[nodiscard]] std::vector<Region> cut_into_regions(std::span<const PrimitiveIndex> primitives,
                                                   std::span<const AlignedBox> reach, std::size_t limit);

}  // namespace cloud2csg
