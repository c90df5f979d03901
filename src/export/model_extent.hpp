#pragma once

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// A finite box around all that is finite in a model, with room to spare: what stands for "all of space" where a format
/// knows only bounded solids, and where unbounded solids are cut.
[[nodiscard]] AlignedBox model_extent(const CsgTree& tree, const PrimitiveSet& primitives);

}  // namespace cloud2csg
