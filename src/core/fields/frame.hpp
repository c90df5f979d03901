#pragma once

#include "cloud2csg/primitive.hpp"

/// The frame in which distances to many points are computed: with its origin among the points where numbers are short.
namespace cloud2csg {

/// Whether distances in single precision, in a frame whose origin is in the middle of the points' bounds, are good
/// enough for points with such noise: rounding is then a five-thousandth of it. O(primitives)
[[nodiscard]] bool is_single_enough(const AlignedBox& points, const PrimitiveSet& primitives, double noise);

/// Moves the primitives to the frame with that origin. `Real` is what they will be evaluated in: for floats, plain
/// half-spaces are also moved along their planes, so that their poses are near.
template <class Real>
void move_to_frame(PrimitiveSet& primitives, const Eigen::Vector3d& origin);

extern template void move_to_frame<double>(PrimitiveSet&, const Eigen::Vector3d&);
extern template void move_to_frame<float>(PrimitiveSet&, const Eigen::Vector3d&);

}  // namespace cloud2csg
