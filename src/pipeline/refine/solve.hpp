#pragma once

#include <Eigen/Core>
#include <vector>

#include "cloud2csg/run_context.hpp"
#include "pipeline/refine/arrangement.hpp"

namespace cloud2csg {

/// The points that a primitive is refined on.
using OwnedPoints = std::vector<Points>;  // by primitive

/// What the points leave uncertain of a member's unknowns: standard deviations, with what is known without points.
struct MemberUncertainty {
  double turn;  ///< of its axis, or of the whole where it has none, in the worst direction, in radians
  std::vector<double> slots;
};

/// Moves the unknowns to where the points' distances from their primitives, in multiples of the noise and under Tukey's
/// loss, are least; a slight pull to where they were keeps those that no point determines. By Levenberg-Marquardt.
/// `primitives` are what the arrangement was made from.
void solve(Arrangement& arrangement, const PrimitiveSet& primitives, const OwnedPoints& points, double noise);

/// Of one member with a frame of its own.
[[nodiscard]] MemberUncertainty uncertainty_of(const Arrangement& arrangement, const Arrangement::Member& member,
                                               const Primitive& primitive, const Points& points, double noise);

}  // namespace cloud2csg
