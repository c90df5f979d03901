#pragma once

#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg::scad {

/// All numbers of a solid's shape and pose: equal for equal solids.
[[nodiscard]] std::vector<double> key_of(const Primitive& primitive);

}  // namespace cloud2csg::scad
