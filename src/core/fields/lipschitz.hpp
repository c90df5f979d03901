#pragma once

#include "cloud2csg/csg_tree.hpp"

/// How fast a field may change: |f(p) - f(q)| <= L |p - q| for all p and q.
namespace cloud2csg {

/// Of a primitive's signed distance: 1; with a displacement of frequency k, 1 + k, which is sharp (see the source).
/// Infinite for an Expression, of which nothing is known.
[[nodiscard]] double lipschitz_bound(const Primitive& primitive);
/// Of a tree's implicit value; at least 1. Minimum, maximum and negation of fields are no steeper than the steepest.
[[nodiscard]] double lipschitz_bound(const CsgTree& tree, const PrimitiveSet& primitives);

/// The same, but finite for an Expression: twice the steepest slope among samples in its bounds, since the steepest
/// place lies between them. Proves nothing there.
[[nodiscard]] double lipschitz_estimate(const Primitive& primitive);
[[nodiscard]] double lipschitz_estimate(const CsgTree& tree, const PrimitiveSet& primitives);

}  // namespace cloud2csg
