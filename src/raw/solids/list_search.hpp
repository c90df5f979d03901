#pragma once

#include <optional>

#include "cloud2csg/run_context.hpp"
#include "raw/solids/decision_list.hpp"

namespace cloud2csg {

struct ListLimits {
  std::size_t rules = 0;
  /// Limit on the sum of places times priced families over all tried rules. Beyond, no list is improved and only simple
  /// terms are added. A count keeps the result independent of the machine; it is some six seconds on one core. The
  /// largest tested part takes half of it. At half, such parts would lose rules. At double, a cloud that does not
  /// consist of our surfaces takes twice the time.
  double work = 3e9;
};

/// A decision list of low cost. From several starts, inserts the rules that gain most, singly or in pairs that only
/// gain together. Then removes some and grows others in their place while the cost falls. Deterministic. If stopped,
/// the best so far.
[[nodiscard]] DecisionList search_list(const TermSpace& space, const TermCosts& costs, const ListLimits& limits,
                                       const RunContext& run = {});

/// The same from one start: a list over a space to which this one has added planes or places. Absent if that saves
/// nothing.
[[nodiscard]] std::optional<DecisionList> improve_list(DecisionList list, const TermSpace& space,
                                                       const TermCosts& costs, const ListLimits& limits,
                                                       const RunContext& run = {});

}  // namespace cloud2csg
