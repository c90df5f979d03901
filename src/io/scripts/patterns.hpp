#pragma once

#include <span>
#include <variant>
#include <vector>

#include "io/scripts/parts.hpp"

/// Parts that repeat: what a person would write as a loop.
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
/// One member, and its mirror image.
struct MirrorPattern {
  MirrorPlane plane;
};

struct Pattern {
  std::vector<std::size_t> members;  ///< numbers of parts, in their order along the line or circle, or row by row
  std::variant<LinePattern, GridPattern, CirclePattern, MirrorPattern> motion;
  double deviation = 0;  ///< how far at most a member is from where the pattern puts it, in size, place and turn
};

/// Patterns of equal parts, those of most members first; each part is in one at most. Three or more in a line or on a
/// circle, or four or more in a grid. Of parts of several solids, two are one as well: mirror images, or else a line.
/// Four at the corners of a square are a grid if its sides lie along the axes of coordinates, else a circle. None
/// deviates by more than `tolerance`. Of more than 256 equal parts, none is looked for; in circles and mirrors, of more
/// than 48. O(n^3 x patterns) for n equal parts
[[nodiscard]] std::vector<Pattern> find_patterns(std::span<const Part> parts, double tolerance);

/// The member at a place of a pattern (0 is the first) as the pattern makes it from the first.
[[nodiscard]] Part member_of(std::span<const Part> parts, const Pattern& pattern, std::size_t place);

}  // namespace cloud2csg::script
