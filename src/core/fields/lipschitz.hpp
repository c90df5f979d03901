#pragma once

#include "cloud2csg/csg_tree.hpp"

/// Lipschitz constants L of fields: |f(p) - f(q)| <= L |p - q| for all p and q.
namespace cloud2csg {

/// For a primitive: 1, or 1 + k with a displacement of frequency k (sharp, see the source). Infinite for an Expression.
[[nodiscard]] double lipschitz_bound(const Primitive& primitive);
/// For a tree: at least 1. Minimum, maximum and negation are no steeper than their steepest field.
[[nodiscard]] double lipschitz_bound(const CsgTree& tree, const PrimitiveSet& primitives);

/// As lipschitz_bound(), but an estimate for an Expression: twice the steepest slope among samples in its bounds.
[[nodiscard]] double lipschitz_estimate(const Primitive& primitive);
[[nodiscard]] double lipschitz_estimate(const CsgTree& tree, const PrimitiveSet& primitives);

}  // namespace cloud2csg
