#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "cloud2csg/run_context.hpp"
#include "pipeline/refine/slots.hpp"

namespace cloud2csg {

/// Unknowns that primitives share: turns and slot values. So directions stay exactly parallel and values exactly equal.
struct Arrangement {
  struct Member {
    PrimitiveIndex primitive;
    std::size_t frame;
    Eigen::Quaterniond in_frame;         ///< axes of the member in the frame
    std::vector<std::size_t> variables;  ///< one per slot, all different
    std::vector<double> signs;           ///< slot value = sign * variable, with sign 1 or -1
  };

  std::vector<LocalFrame> frames;
  std::vector<Member> members;
  std::vector<double> values;  ///< by variable
  std::vector<double> loose;   ///< by variable: prior standard deviation, without points
};

/// One frame per primitive; leaves out primitives without slots or points (absent origins).
[[nodiscard]] Arrangement separate(const PrimitiveSet& primitives,
                                   const std::vector<std::optional<Eigen::Vector3d>>& origins);

/// The member's frame after turning its shared frame by a rotation vector (radians, in the world).
[[nodiscard]] LocalFrame frame_of(const Arrangement& arrangement, const Arrangement::Member& member,
                                  const Eigen::Vector3d& turn = Eigen::Vector3d::Zero());

/// The primitives with the arrangement's values; non-members as given.
[[nodiscard]] PrimitiveSet arranged(const Arrangement& arrangement, PrimitiveSet primitives);

/// Prior standard deviation of a primitive's values: a share of its size.
[[nodiscard]] double looseness(const Primitive& primitive);

/// The points that each primitive is fitted to.
using OwnedPoints = std::vector<Points>;  // by primitive

/// Standard deviations of a member's unknowns from the points and the prior.
struct MemberUncertainty {
  double turn;  ///< worst direction, in radians: of the axis, or of the whole without an axis
  std::vector<double> slots;
};

/// Minimises the distances of points from their primitives, in multiples of the noise and under Tukey's loss, by
/// Levenberg-Marquardt. A weak pull keeps undetermined unknowns. `primitives` are those of the arrangement.
void solve(Arrangement& arrangement, const PrimitiveSet& primitives, const OwnedPoints& points, double noise);

/// For one member with a frame of its own.
[[nodiscard]] MemberUncertainty uncertainty_of(const Arrangement& arrangement, const Arrangement::Member& member,
                                               const Primitive& primitive, const Points& points, double noise);

}  // namespace cloud2csg
