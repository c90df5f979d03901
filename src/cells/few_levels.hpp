#pragma once

#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {

/// The same solid in fewer levels, as a person writes it. Where something is subtracted from a union, only the operands
/// that it shares a cell with go into the difference; operands that nothing joins stand side by side. Where that saves
/// no level, differences stay outermost. The leaves stay. Places change only where primitives overlap and no cell that
/// was found tells. The result has no more levels than the tree. O(size x log size) for each difference within a union,
/// and the neighbours of what it subtracts.
[[nodiscard]] CsgTree with_few_levels(const CsgTree& tree, const CellComplex& complex);

}  // namespace cloud2csg
