#pragma once

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// Precondition: the operation has two children.
[[nodiscard]] CsgTree join(Operation operation, const CsgTree& a, const CsgTree& b);

}  // namespace cloud2csg
