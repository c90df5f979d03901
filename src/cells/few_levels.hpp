#pragma once

#include "cloud2csg/cells.hpp"

namespace cloud2csg {

/// The same solid as a person writes it, in fewer levels: of a union from which something is taken away, only the
/// operands that it cuts need to be within the difference, and those that nothing joins stand side by side. Where that
/// saves no level, differences stay outermost. The leaves stay, and so does the value at every cell that was found; the
/// result has no more levels than the tree. O(size x log size) for each difference within a union, and the cells that
/// what it takes away has a part in.
[[nodiscard]] CsgTree with_few_levels(const CsgTree& tree, const CellComplex& complex);

}  // namespace cloud2csg
