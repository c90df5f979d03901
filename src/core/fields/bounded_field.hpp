#pragma once

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// The same solid with meaningful values everywhere: each expression leaf is intersected with the box of its bounds,
/// beyond which its formula means nothing. The boxes follow the primitives of `solid`. O(size x expressions)
[[nodiscard]] Model bounded_field(const Model& solid);

}  // namespace cloud2csg
