#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "raw/solids/decision_list.hpp"

namespace cloud2csg {

/// The bins that the part's range counts. Precondition: it is no polytope.
[[nodiscard]] const Bins& bins_of(const TermSpace& space, const TermPart& part);

/// Whether a rule subtracts everything but its second part. Then its first part need not be written.
[[nodiscard]] bool keeps_one_part(const Rule& rule);

/// The list with the ends of all parts moved inward as long as it decides all places as before. Where a rule that
/// subtracts can do so from everything instead of its first part, it does. O(rules x bins x places)
[[nodiscard]] DecisionList drawn_in(const TermSpace& space, DecisionList list);

/// By end of a part: whether it moves into a bin that makes no difference.
using Overshoots = std::array<bool, 2>;

/// The ends that may lie anywhere in the next bin, by rule and part. Any choice of such ends leaves all decisions
/// unchanged. O(rules x places)
[[nodiscard]] std::vector<std::vector<Overshoots>> free_ends(const TermSpace& space, const DecisionList& list);

}  // namespace cloud2csg
