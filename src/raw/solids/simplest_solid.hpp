#pragma once

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// An extrusion or revolution as the box, cylinder, cone, sphere or torus that it is up to rounding, a polytope with
/// two ends across all other faces as an extrusion or box; others unchanged.
[[nodiscard]] Primitive simplest(const Primitive& solid);

}  // namespace cloud2csg
