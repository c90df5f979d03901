#pragma once

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// The same solid, every value of which means something everywhere: each leaf that is an expression becomes its
/// intersection with the box of its bounds, beyond which its formula means nothing. The boxes follow the primitives of
/// `solid`. O(size x expressions)
[[nodiscard]] Model bounded_field(const Model& solid);

}  // namespace cloud2csg
