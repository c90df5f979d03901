#pragma once

#include "cloud2csg/run_context.hpp"
#include "paper/overlap/overlap_body.hpp"

namespace cloud2csg {

/// Whether two solids are at most `tolerance` apart; one inside the other overlaps it.
///
/// Exact, up to rounding: spheres, half-spaces, and pairs of convex solids, where gaps that differ from the
/// tolerance by less than about 1e-8 of the solids' size may go either way.
/// By distance fields: see fields_overlap().
/// @throws Cancelled
[[nodiscard]] bool bodies_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance, const RunContext& run);

/// For two bounded convex bodies: do they, each grown by half the tolerance, intersect? Minkowski portal refinement.
[[nodiscard]] bool convex_bodies_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance);

/// For any two bodies with bounds in common: is there a point that is within half the tolerance of both? Branch and
/// bound over the common bounds: a cell is dropped when a field's Lipschitz bound proves the whole cell to
/// be outside of one solid.
///
/// "No" is proven where the Lipschitz constants are (all shapes but expressions, whose constant is estimated).
/// "Yes" is proven by a point, within the fields' own accuracy: a displaced or expression field is divided by its
/// Lipschitz constant, so such a solid may count as larger by tolerance * lipschitz / 2. When the budget of
/// evaluations ends first, the gap is smaller than the cells can tell (about 1/500 of the common bounds), and the
/// answer is yes: an edge too many costs time, an edge too few costs the right tree.
/// @throws Cancelled
[[nodiscard]] bool fields_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance, const RunContext& run);

}  // namespace cloud2csg
