#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/advanced/formula.hpp"

namespace cloud2csg {

/// A partial function without what says nothing: each assignment once, no variable that is the same in all rows, and of
/// variables that are equal, or each other's complement, in all rows the first.
struct ReducedFunction {
  std::vector<PrimitiveIndex> variables;       ///< ascending
  std::vector<std::vector<bool>> assignments;  ///< by row: whether each of the variables is true; different, ascending
  std::vector<bool> values;                    ///< by row
};

/// O(variables^2 x rows + rows x log rows x variables)
[[nodiscard]] ReducedFunction reduce(const PartialFunction& function);

/// Two rows of a reduced function whose assignments differ in one variable.
struct RowPair {
  std::size_t row_without;
  std::size_t row_with;
};

/// All such pairs, by variable. Where the values of a pair differ, each formula has the variable: plain when the value
/// rises with it, complemented when it falls, and so twice when there are both. O(rows x log rows x variables^2)
[[nodiscard]] std::vector<std::vector<RowPair>> neighbours(const ReducedFunction& function);

}  // namespace cloud2csg
