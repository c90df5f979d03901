#pragma once

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// @throws Error (where = "planes" or "planes/3") when a plane is not finite, a normal is not of unit length, or the
/// planes' half-spaces have no bounded intersection with volume. O(planes^4).
void validate_polytope(const Polytope& polytope);

/// The polytope with every plane moved outward by `distance`: where the largest of the planes' distances is below it.
[[nodiscard]] Polytope grown(const Polytope& polytope, double distance);

}  // namespace cloud2csg
