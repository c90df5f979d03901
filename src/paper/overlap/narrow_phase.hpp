#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cloud2csg/primitive.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// How the overlap of a solid with another is decided.
enum class BodyKind : std::uint8_t {
  sphere,      ///< undisplaced: closed form with another sphere, else as convex
  convex,      ///< bounded, convex, undisplaced: by its support function
  half_space,  ///< undisplaced and without an extent: closed forms
  field,       ///< all others: by the distance field
};

/// A primitive prepared for many pair tests.
struct OverlapBody {
  Primitive solid;    ///< an unbounded primitive with an extent becomes the box of that extent
  AlignedBox bounds;  ///< infinite for half-spaces
  BodyKind kind = BodyKind::field;
  std::vector<Eigen::Vector3d> corners = {};         ///< corners of a polytope, in the world
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< a point inside, for convex kinds
  /// Lipschitz constant of the distance. An estimate for expressions.
  double lipschitz = 1.0;

  [[nodiscard]] bool is_bounded() const { return bounds.sizes().allFinite(); }
};

/// `extent` counts only for a primitive whose own bounds are infinite.
[[nodiscard]] OverlapBody make_overlap_body(const Primitive& primitive, const std::optional<OrientedBox>& extent);

/// Whether two solids are at most `tolerance` apart; one inside the other overlaps it. Exact up to rounding for
/// spheres, half-spaces and pairs of convex solids. Gaps of the latter that differ from the tolerance by less than
/// about 1e-8 of the solids' size may go either way. Other pairs go by distance fields, within a budget. A "no" is
/// proven but for expressions, whose Lipschitz constant is estimated. Where the budget ends the answer is yes: an extra
/// edge costs only time. A displaced solid or an expression may count as larger by tolerance x Lipschitz constant / 2.
/// @throws Cancelled
[[nodiscard]] bool bodies_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance, const RunContext& run);

}  // namespace cloud2csg
