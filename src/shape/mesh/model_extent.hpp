#pragma once

#include <optional>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// A finite box around all that is finite in a model, with room to spare: what stands for "all of space" where a format
/// knows only bounded solids, and where unbounded solids are cut.
[[nodiscard]] AlignedBox model_extent(const Model& model);

/// The extent when the solid goes on beyond it. Looks at a lattice on the box's faces: a beam thinner than about a
/// hundredth of the box can be missed. O(size).
[[nodiscard]] std::optional<AlignedBox> cut_at(const Model& model, const AlignedBox& extent);

}  // namespace cloud2csg
