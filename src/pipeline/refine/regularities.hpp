#pragma once

#include <span>
#include <vector>

#include "pipeline/refine/solve.hpp"

namespace cloud2csg {

/// Directions that are parallel and orthogonal to each other, and whose they are.
struct DirectionGroup {
  struct Member {
    std::size_t member;           ///< index into the members of the separate arrangement
    Eigen::Quaterniond in_frame;  ///< its own axes in the group's, turned by multiples of 90 degrees
    double angle;                 ///< by how much it was off, in radians
  };
  Eigen::Quaterniond orientation;
  bool is_complete;  ///< false: only the z axis means something, all members are solids of revolution around it
  std::vector<Member> members;
};

/// Every member is in one group; those that are alone, or have no directions to be compared, in one of their own.
/// Undisplaced spheres are in the group with the most points, so that their centres can be in line with others.
[[nodiscard]] std::vector<DirectionGroup> group_directions(const Arrangement& separate, const PrimitiveSet& primitives,
                                                           std::span<const MemberUncertainty> uncertainties,
                                                           const OwnedPoints& points, double angle);

/// How near to regular is regular.
struct RegularityLimits {
  double angle;             ///< radians
  double value;             ///< in the cloud's units: no values farther apart are made equal
  bool with_values = true;  ///< false: directions only
};

/// An arrangement in which what is nearly regular is so, and what that changed.
struct RegularArrangement {
  Arrangement arrangement;
  std::vector<Regularity> regularities;
  std::size_t unknowns_saved = 0;
};

/// `separate` is an arrangement of primitives each for itself, with what is uncertain of each member. `given` are the
/// primitives as they were before all: values that were equal there stay so even where no point determines them.
[[nodiscard]] RegularArrangement regularised(const Arrangement& separate, const PrimitiveSet& primitives,
                                             const PrimitiveSet& given,
                                             std::span<const MemberUncertainty> uncertainties,
                                             const OwnedPoints& points, const RegularityLimits& limits);

}  // namespace cloud2csg
