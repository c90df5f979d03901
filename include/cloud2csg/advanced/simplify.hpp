#pragma once

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// Rewrites by rules of set algebra to a fixed point: idempotence (a | a), absorption (a | (a & b)), double
/// complement, De Morgan, complements turned into differences (a & ~b), empty and full, complementary pairs (a & ~a),
/// nested differences (a - (a - b) = a & b), anything that follows from what surrounds it ((a | b) - b = a - b), common
/// factors
/// ((a & b) | (a & c) = a & (b | c), (a - c) | (b - c) = (a | b) - c). Uses only the formula, no geometry.
///
/// Membership never changes, the size never grows, and a second simplify changes nothing. The result has one shape for
/// each formula: what is subtracted is united first (a - (b | c)), chains lean to the left, in the order of first
/// appearance, and a complement stands at most at the root, where the solid is unbounded: n leaves make 2 n - 1 nodes,
/// or 2 n. The result is a single node, empty or full, or holds neither. Mostly O(size log size), O(size^2) in the
/// worst case.
[[nodiscard]] CsgTree simplify(const CsgTree& tree);

}  // namespace cloud2csg
