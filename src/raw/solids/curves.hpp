#pragma once

#include <cstddef>
#include <vector>

#include "core/primitive/profile.hpp"

namespace cloud2csg {

/// A line normal . p = offset, or a circle.
struct Curve {
  bool is_circle = false;
  Vector2d normal = Vector2d::UnitX();  ///< of a line, or the centre of a circle
  double offset = 0;                    ///< of a line, or the radius of a circle
  std::vector<Vector2d> points = {};    ///< some of its points; of a hidden line, two far away
  std::size_t count = 0;                ///< of all its points; 0 for a line that is hidden

  [[nodiscard]] double distance(const Vector2d& p) const {
    return is_circle ? std::abs((p - normal).norm() - offset) : std::abs(normal.dot(p) - offset);
  }
  /// Length along the curve, from its start: the foot of the origin, or the circle's +x.
  [[nodiscard]] double along(const Vector2d& p) const {
    if (!is_circle) return to_the_left(normal).dot(p);
    const Vector2d arm = p - normal;
    return offset * std::atan2(arm.y(), arm.x());
  }
};

/// Equal curves become one, with the values of the one with the most points.
[[nodiscard]] std::vector<Curve> merged(std::vector<Curve> curves, double tolerance);

/// Circles that come within `tolerance` of other curves grow until they touch, so that faces close. `reach` as below.
[[nodiscard]] std::vector<Curve> with_closed_gaps(std::vector<Curve> curves, double reach, double tolerance);

/// The part of the curve with points, and `reach` more on either side, of a circle at least 0.35 radians.
[[nodiscard]] std::vector<ProfileSegment> pieces_of(const Curve& curve, double reach);

/// The length of a piece of the curve that is farther than `near` from all its points; all of it without points.
[[nodiscard]] double bare_length(const ProfileSegment& piece, const Curve& curve, double near);

}  // namespace cloud2csg
