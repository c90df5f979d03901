#pragma once

#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {

/// The same solid as a person writes it, in fewer levels: of a union from which something is taken away, only the
/// operands that it shares a cell with need to be within the difference, and those that nothing joins stand side by
/// side. Where that saves no level, differences stay outermost. The leaves stay, and no place changes but where
/// primitives overlap and no cell that was found tells; the result has no more levels than the tree.
/// O(size x log size) for each difference within a union, and the neighbours of what it takes away.
[[nodiscard]] CsgTree with_few_levels(const CsgTree& tree, const CellComplex& complex);

}  // namespace cloud2csg
