#pragma once

#include "io/openscad/flat_shapes.hpp"

namespace cloud2csg::scad {

/// The same region with fewer shapes: those that a difference takes from inside another, and disjoint ones of a union,
/// become paths of one profile. O(shapes x segments), and as the second power of the segments that are near each other,
/// of which very many stay shapes of their own.
[[nodiscard]] FlatTree joined(FlatTree tree);

}  // namespace cloud2csg::scad
