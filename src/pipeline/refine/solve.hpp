#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "cloud2csg/run_context.hpp"
#include "pipeline/refine/slots.hpp"

namespace cloud2csg {

/// Unknowns that several primitives share: a turn, and values of slots. That directions are parallel and values equal
/// then holds exactly, whatever the unknowns are.
struct Arrangement {
  /// A primitive, and where it has its unknowns.
  struct Member {
    PrimitiveIndex primitive;
    std::size_t frame;
    Eigen::Quaterniond in_frame;         ///< its own axes in the frame's
    std::vector<std::size_t> variables;  ///< a slot each; no two are the same
    std::vector<double> signs;           ///< the slot's value is this times the variable: 1 or -1
  };

  std::vector<LocalFrame> frames;
  std::vector<Member> members;
  std::vector<double> values;  ///< by variable
  std::vector<double> loose;   ///< by variable: how far it may be off before the points are asked
};

/// Each primitive for itself; those without slots or points (absent origins) are no members.
[[nodiscard]] Arrangement separate(const PrimitiveSet& primitives,
                                   const std::vector<std::optional<Eigen::Vector3d>>& origins);

/// The member's own frame, with its frame turned by a rotation vector (radians, in the world).
[[nodiscard]] LocalFrame frame_of(const Arrangement& arrangement, const Arrangement::Member& member,
                                  const Eigen::Vector3d& turn = Eigen::Vector3d::Zero());

/// The primitives as the arrangement has them; others as given.
[[nodiscard]] PrimitiveSet arranged(const Arrangement& arrangement, PrimitiveSet primitives);

/// How far a primitive's values may be off before its points are asked: a share of its size.
[[nodiscard]] double looseness(const Primitive& primitive);

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
