#pragma once

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// An extrusion or revolution as the box, cylinder, cone, sphere or torus that it is up to rounding, or unchanged.
[[nodiscard]] Primitive simplest(const Primitive& solid);

}  // namespace cloud2csg
