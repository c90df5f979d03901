#pragma once

#include <span>
#include <vector>

#include "pipeline/refine/solve.hpp"

namespace cloud2csg {

/// A group of parallel and orthogonal directions, with its members.
struct DirectionGroup {
  struct Member {
    std::size_t member;           ///< index into the members of the separate arrangement
    Eigen::Quaterniond in_frame;  ///< axes of the member in the group: multiples of 90 degrees
    double angle;                 ///< deviation before snapping, in radians
  };
  Eigen::Quaterniond orientation;
  bool is_complete;  ///< false: only the z axis is defined; all members are solids of revolution around it
  std::vector<Member> members;
};

/// Every member is in one group. Members without matching or comparable directions have a group of their own.
/// Undisplaced spheres join the group with the most points, so that their centres can align with others.
[[nodiscard]] std::vector<DirectionGroup> group_directions(const Arrangement& separate, const PrimitiveSet& primitives,
                                                           std::span<const MemberUncertainty> uncertainties,
                                                           const OwnedPoints& points, double angle);

/// Limits within which values become regular.
struct RegularityLimits {
  double angle;             ///< radians
  double value;             ///< values farther apart, in the cloud's units, are not made equal
  bool with_values = true;  ///< false: directions only
};

/// An arrangement with exact regularities, and the list of changes.
struct RegularArrangement {
  Arrangement arrangement;
  std::vector<Regularity> regularities;
  std::size_t unknowns_saved = 0;
};

/// `separate` has a frame per primitive, with the uncertainties of each member. `given` are the original primitives:
/// values that were equal there stay equal even where no point determines them.
[[nodiscard]] RegularArrangement regularised(const Arrangement& separate, const PrimitiveSet& primitives,
                                             const PrimitiveSet& given,
                                             std::span<const MemberUncertainty> uncertainties,
                                             const OwnedPoints& points, const RegularityLimits& limits);

}  // namespace cloud2csg
