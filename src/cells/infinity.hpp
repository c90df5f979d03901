#pragma once

#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {

/// The cells that reach to infinity, ascending: which half-spaces hold what lies far off in each of many directions.
/// Only the cell outside of all where there are none.
[[nodiscard]] std::vector<Cell> cells_at_infinity(const PrimitiveSet& primitives);

}  // namespace cloud2csg
