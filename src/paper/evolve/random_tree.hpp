#pragma once

#include "cloud2csg/csg_tree.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {

/// A random tree over primitives 0 .. count - 1 of at most `height` edges from root to leaf: at each node a leaf or an
/// operation with equal chance, operations with equal chance, down to leaves at the limit.
[[nodiscard]] CsgTree random_tree(std::size_t count, int height, RandomStream& random);

}  // namespace cloud2csg
