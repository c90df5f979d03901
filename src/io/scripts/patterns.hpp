#pragma once

#include <span>
#include <variant>
#include <vector>

#include "io/scripts/parts.hpp"

/// Repeated parts that a person would write as a loop.
namespace cloud2csg::script {

struct LinePattern {
  Eigen::Vector3d step;  ///< from one member to the next
};
/// Equal rows at equal steps.
struct GridPattern {
  Eigen::Vector3d step;      ///< from one member of a row to the next
  Eigen::Vector3d row_step;  ///< from one row to the next
  std::size_t columns;       ///< members of a row
};
/// Equal angles about an axis. The members turn with the angle.
struct CirclePattern {
  Eigen::Vector3d centre;
  Eigen::Vector3d axis;  ///< unit length
  double angle_deg;      ///< from one member to the next
  bool is_full;          ///< the member after the last is the first
};
/// A member and its mirror image.
struct MirrorPattern {
  MirrorPlane plane;
};

struct Pattern {
  std::vector<std::size_t> members;  ///< indices of parts along the line or circle, or row by row
  std::variant<LinePattern, GridPattern, CirclePattern, MirrorPattern> motion;
  double deviation = 0;  ///< largest deviation of a member from the pattern in size, position and orientation
};

/// Patterns of equal parts, those with most members first. Each part is in at most one pattern, and none deviates by
/// more than `tolerance`. A line or circle has three or more members, a grid four or more. Two parts, each with
/// several solids, suffice: mirror images or else a line. The corners of a square are a grid if its sides are parallel
/// to the coordinate axes, else a circle. Limits: 256 equal parts, 48 for circles and mirrors. O(n^3 x patterns)
[[nodiscard]] std::vector<Pattern> find_patterns(std::span<const Part> parts, double tolerance);

/// The member at a place of a pattern (0 is the first), made from the first member.
[[nodiscard]] Part member_of(std::span<const Part> parts, const Pattern& pattern, std::size_t place);

}  // namespace cloud2csg::script
