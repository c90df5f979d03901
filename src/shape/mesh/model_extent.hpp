#pragma once

#include <optional>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// A finite box around all finite parts of a model, with room to spare. It replaces "all of space" in formats of
/// bounded solids, and cuts unbounded solids.
[[nodiscard]] AlignedBox model_extent(const Model& model);

/// The extent, if the solid continues beyond it. Samples a lattice on the box's faces, so it can miss a beam thinner
/// than about a hundredth of the box. O(size).
[[nodiscard]] std::optional<AlignedBox> cut_at(const Model& model, const AlignedBox& extent);

}  // namespace cloud2csg
