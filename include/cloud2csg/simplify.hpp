#pragma once

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// Rewrites by rules of set algebra to a fixed point: idempotence (a | a), absorption (a | (a & b)), double
/// complement, De Morgan where it shrinks, complements turned into differences (a & ~b), empty and full, nested differences
/// ((a - b) - c, a - (a - b)). Membership never changes, the size never grows. Uses only the formula, no geometry.
/// O(size^2) in the worst case.
[[nodiscard]] CsgTree simplify(const CsgTree& tree);

}  // namespace cloud2csg
