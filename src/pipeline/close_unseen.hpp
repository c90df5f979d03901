#pragma once

#include "pipeline/find_primitives.hpp"

namespace cloud2csg {

/// With points and surfaces added where no sensor saw the part: find_unseen_side(), find_hidden_walls(). Warnings say
/// what was closed, and where. Precondition: the surfaces are detected.
[[nodiscard]] FoundPrimitives with_unseen_closed(FoundPrimitives found, const RunContext& run);

}  // namespace cloud2csg
