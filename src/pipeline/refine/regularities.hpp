#pragma once

#include <vector>

#include "pipeline/refine/arrangement.hpp"
#include "pipeline/refine/solve.hpp"

namespace cloud2csg {

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
