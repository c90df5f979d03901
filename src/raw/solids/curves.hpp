#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/primitive/profile.hpp"

namespace cloud2csg {

/// A line normal . p = offset, or a circle.
struct Curve {
  bool is_circle = false;
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< of a line, or the centre of a circle
  double offset = 0;                                  ///< of a line, or the radius of a circle
  std::vector<Eigen::Vector2d> points = {};           ///< some of its points; of a hidden line, two far away
  std::size_t count = 0;                              ///< of all its points; 0 for a line that is hidden

  [[nodiscard]] double distance(const Eigen::Vector2d& p) const {
    return is_circle ? std::abs((p - normal).norm() - offset) : std::abs(normal.dot(p) - offset);
  }
  /// Length along the curve, from its start: the foot of the origin, or the circle's +x.
  [[nodiscard]] double along(const Eigen::Vector2d& p) const {
    if (!is_circle) return to_the_left(normal).dot(p);
    const Eigen::Vector2d arm = p - normal;
    return offset * std::atan2(arm.y(), arm.x());
  }
};

/// Whether curves differ by no more than the tolerance; lines by twice that at the points of `b`.
[[nodiscard]] bool is_same(const Curve& a, const Curve& b, double tolerance);

/// Equal curves become one, with the values of the one with the most points.
[[nodiscard]] std::vector<Curve> merged(std::vector<Curve> curves, double tolerance);

/// Circles that come within `tolerance` of other curves grow until they touch, so that faces close. `reach` as below.
[[nodiscard]] std::vector<Curve> with_closed_gaps(std::vector<Curve> curves, double reach, double tolerance);

/// The box of the points, grown by at most `tolerance` to where circles with points nearby end: the outermost point of
/// a circle is hardly ever among the points. O(points of the circles)
[[nodiscard]] Eigen::AlignedBox2d with_ends_of_circles(const Eigen::AlignedBox2d& seen, std::span<const Curve> curves,
                                                       double tolerance);

/// A part of a curve, along it. `high` is the greater one, also where a circle's part contains its start.
struct CurveExtent {
  double low = 0, high = 0;
};

/// The parts of the curves with points, and `reach` more on either side, of a circle at least 0.35 radians. An end that
/// meets no other curve there goes on to the crossing for which both curves together grow least, because the corner may
/// be hidden. O(curves^2)
[[nodiscard]] std::vector<CurveExtent> extents_of(std::span<const Curve> curves, double reach);

/// One segment for a line, two for a circle. Of a turned drawing the parts with x >= 0. O(1)
[[nodiscard]] std::vector<ProfileSegment> pieces_of(const Curve& curve, const CurveExtent& extent,
                                                    bool is_turned = false);

/// The length of a piece of the curve that is farther than `near` from all its points; all of it without points.
[[nodiscard]] double bare_length(const ProfileSegment& piece, const Curve& curve, double near);

}  // namespace cloud2csg
