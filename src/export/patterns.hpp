#pragma once

#include <span>
#include <variant>
#include <vector>

#include "cloud2csg/primitive.hpp"

/// Solids that repeat: what a person would write as a loop.
namespace cloud2csg::script {

/// Equal steps.
struct LinePattern {
  Eigen::Vector3d step;  ///< from one member to the next
};
/// Rows of equal steps, at equal steps from each other.
struct GridPattern {
  Eigen::Vector3d step;      ///< from one member of a row to the next
  Eigen::Vector3d row_step;  ///< from one row to the next
  std::size_t columns;       ///< members of a row
};
/// Equal angles about an axis, which the members turn with.
struct CirclePattern {
  Eigen::Vector3d centre;
  Eigen::Vector3d axis;  ///< of unit length
  double angle_deg;      ///< from one member to the next
  bool is_full;          ///< the member after the last is the first
};

struct Pattern {
  std::vector<PrimitiveIndex> members;  ///< in their order along the line or circle, or row by row
  std::variant<LinePattern, GridPattern, CirclePattern> motion;
  double deviation = 0;  ///< how far at most a member is from where the pattern puts it, in size, place and turn
};

/// Patterns of boxes, spheres, cylinders, cones and tori of equal size among `candidates`, those of most members first;
/// each candidate is in one at most. Three or more in a line or on a circle, or four or more in a grid. None deviates
/// by more than `tolerance`. Of more than 256 equal solids, none is looked for; in circles, of more than 48. O(n^3 x
/// patterns) for n equal solids
[[nodiscard]] std::vector<Pattern> find_patterns(const PrimitiveSet& primitives,
                                                 std::span<const PrimitiveIndex> candidates, double tolerance);

/// The member at a place of a pattern (0 is the first) as the pattern makes it from the first.
[[nodiscard]] Primitive member_of(const PrimitiveSet& primitives, const Pattern& pattern, std::size_t place);

/// How far the surfaces of two solids are apart at most, about; infinite for solids of different or of other types than
/// those of patterns.
[[nodiscard]] double misfit(const Primitive& a, const Primitive& b);

}  // namespace cloud2csg::script
