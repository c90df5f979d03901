#pragma once

#include "io/openscad/flat_shapes.hpp"

namespace cloud2csg::scad {

/// The same region with fewer shapes: those that a difference takes from inside another, and disjoint ones of a union,
/// become paths of one profile, up to 5000 paths. O(segments^2)
[[nodiscard]] FlatTree joined(const FlatTree& tree);

}  // namespace cloud2csg::scad
