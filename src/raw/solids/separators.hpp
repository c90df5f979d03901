#pragma once

#include <vector>

#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/run_context.hpp"
#include "raw/solids/write_solids.hpp"

namespace cloud2csg {

/// Planes below lumps that are wrongly in the written solid, which separate them from the places that are rightly in
/// it: of each lump that weighs at least so much. What lies behind a groove, for instance, has no surface of its own,
/// so that the surfaces of the boundary do not suffice for a formula (Shapiro and Vossler 1993: separating
/// half-spaces). Where no plane separates them, the one with the best logistic regression. O(places) for each lump.
/// If stopped, those so far.
[[nodiscard]] std::vector<Surface> separating_planes(const WrittenSolids& written, const LabelledPlaces& places,
                                                     double least_weight, const RunContext& run = {});

}  // namespace cloud2csg
