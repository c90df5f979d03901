#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// A line or an arc of a profile. The inside of the profile is on its left.
struct ProfileSegment {
  Eigen::Vector2d start, end;
  double bulge = 0;  ///< as of PathCorner
  // Of arcs only:
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0;
  double angle = 0;  ///< by which the arc turns left, in (-2 pi, 2 pi)

  /// A flatter arc is a line: programs that read our files lose it, too.
  static constexpr double k_least_bulge = 1e-7;
  [[nodiscard]] bool is_arc() const { return std::abs(bulge) > k_least_bulge; }
  /// Whether it is a line with x = 0, which has no surface when the profile is turned.
  [[nodiscard]] bool is_on_axis() const { return !is_arc() && start.x() == 0 && end.x() == 0; }
  [[nodiscard]] double length() const;
  /// The point at this share of the length, in [0, 1], and the outward unit normal there.
  [[nodiscard]] Eigen::Vector2d at(double share) const;
  [[nodiscard]] Eigen::Vector2d normal(double share) const;
  /// Whether the point is to the left of the line through both ends. On the line, as if the point were a little to the
  /// right, and even less higher, so that the point has one place for all segments.
  [[nodiscard]] bool is_left(const Eigen::Vector2d& point) const;
  /// The integral of x over the length: the area is 2 pi times this when the segment turns about x = 0.
  [[nodiscard]] double first_moment() const;
};

/// O(1)
[[nodiscard]] ProfileSegment segment_between(const Eigen::Vector2d& start, double bulge, const Eigen::Vector2d& end);

/// The point of the segment that is nearest to the given one. O(1)
[[nodiscard]] Eigen::Vector2d nearest(const ProfileSegment& segment, const Eigen::Vector2d& point);

/// Points where the whole lines or circles of both cross or nearly touch: one where they come within the tolerance of a
/// touch, none for equal or parallel ones. O(1)
[[nodiscard]] std::vector<Eigen::Vector2d> crossings(const ProfileSegment& a, const ProfileSegment& b,
                                                     double tolerance);

/// Whether the direction from the arc's centre is one of the arc's. O(1)
[[nodiscard]] bool is_in_sector(const ProfileSegment& arc, const Eigen::Vector2d& direction);

/// a.x b.y - a.y b.x
[[nodiscard]] inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// `v` turned left by a quarter.
[[nodiscard]] inline Eigen::Vector2d to_the_left(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

/// All segments: those of regions_of(). O(segments x paths)
[[nodiscard]] std::vector<ProfileSegment> segments_of(const Profile& profile);

/// Without turning: the segments of one path, in the order of its corners. O(segments)
[[nodiscard]] std::vector<ProfileSegment> segments_of(const ClosedPath& path);

/// A connected part of a profile. The outline runs counterclockwise and the holes clockwise.
struct ProfileRegion {
  std::vector<ProfileSegment> outline;
  std::vector<std::vector<ProfileSegment>> holes;
};
/// The connected parts, in the order of their outlines. O(segments x paths)
[[nodiscard]] std::vector<ProfileRegion> regions_of(const Profile& profile);

/// Whether the point is in the region inside an odd number of the segments' paths. O(segments)
[[nodiscard]] bool is_inside(std::span<const ProfileSegment> segments, const Eigen::Vector2d& point);

/// The profile of an extrusion or revolution; null for other shapes.
[[nodiscard]] const Profile* profile_of(const Shape& shape);

/// The segments of all paths, where a whole circle is one. O(segments)
[[nodiscard]] std::size_t count_segments(const Profile& profile);

/// The corners of all paths. O(paths)
[[nodiscard]] std::size_t count_corners(const Profile& profile);

/// The angle from the arc's start to a direction from its centre, as the arc turns: with the arc's sign, below a full
/// turn. O(1)
[[nodiscard]] double angle_from_start(const ProfileSegment& arc, const Eigen::Vector2d& direction);

/// Whether all segments are arcs of one circle, in one direction.
[[nodiscard]] bool is_circle(std::span<const ProfileSegment> path);

/// Twice the area to the left of a closed path. O(segments)
[[nodiscard]] double doubled_area(std::span<const ProfileSegment> segments);

/// Area of the region. Positive for a valid profile. O(segments)
[[nodiscard]] double area_of(const Profile& profile);

/// Least and greatest dot product of the direction (any length) with the points. O(segments)
[[nodiscard]] std::pair<double, double> extent_along(const ProfileSegment& segment, const Eigen::Vector2d& direction);
[[nodiscard]] std::pair<double, double> extent_along(const Profile& profile, const Eigen::Vector2d& direction);

/// O(segments)
[[nodiscard]] Eigen::AlignedBox2d bounds_of(std::span<const ProfileSegment> segments);
[[nodiscard]] Eigen::AlignedBox2d bounds_of(const Profile& profile);

/// @throws Error naming the path and segments (from 0) that cross or touch, or the corner that is not finite.
/// O(segments^2)
void validate_profile(const Profile& profile);

/// As validate_profile(), for a profile that is turned about x = 0. Refuses what touches the axis in a single point: a
/// solid that is pinched there is none for most programs. @throws Error
void validate_turned_profile(const Profile& profile);

}  // namespace cloud2csg
