#include "core/primitive/profile.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

Vector2d turned(const Vector2d& v, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

/// The path in the other direction.
std::vector<ProfileSegment> reversed(std::vector<ProfileSegment> path) {
  std::ranges::reverse(path);
  for (ProfileSegment& segment : path) {
    std::swap(segment.start, segment.end);
    segment.bulge = -segment.bulge;
    segment.angle = -segment.angle;
  }
  return path;
}

/// Points of a circle and a line or another circle whose common chord has this foot as seen from the circle's centre.
/// Where they nearly touch there is one.
std::vector<Vector2d> ends_of_chord(const ProfileSegment& circle, double foot, const Vector2d& direction,
                                    double tolerance) {
  const double off = circle.radius - std::abs(foot);
  if (off < -tolerance) return {};
  const Vector2d middle = circle.centre + std::clamp(foot, -circle.radius, circle.radius) * direction;
  if (off <= tolerance) return {middle};
  const Vector2d half = std::sqrt(circle.radius * circle.radius - foot * foot) * to_the_left(direction);
  return {middle + half, middle - half};
}

}  // namespace

ProfileSegment segment_between(const Vector2d& start, double bulge, const Vector2d& end) {
  ProfileSegment segment{.start = start, .end = end, .bulge = bulge};
  if (!segment.is_arc()) return segment;
  const Vector2d chord = end - start;
  // The sagitta is bulge times half the chord, so the centre is (1 - bulge^2) / (4 bulge) chords to the left of its
  // middle.
  segment.centre = 0.5 * (start + end) + (1 - bulge * bulge) / (4 * bulge) * to_the_left(chord);
  segment.radius = chord.norm() * (1 + bulge * bulge) / (4 * std::abs(bulge));
  segment.angle = 4 * std::atan(bulge);
  return segment;
}

Vector2d nearest(const ProfileSegment& s, const Vector2d& point) {
  if (!s.is_arc()) {
    const Vector2d along = s.end - s.start;
    return s.start + std::clamp((point - s.start).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
  }
  const Vector2d arm = point - s.centre;
  if (arm.squaredNorm() > 0 && is_in_sector(s, arm)) return s.centre + s.radius * arm.normalized();
  return (point - s.start).norm() <= (point - s.end).norm() ? s.start : s.end;
}

std::vector<Vector2d> crossings(const ProfileSegment& a, const ProfileSegment& b, double tolerance) {
  if (!a.is_arc() && b.is_arc()) return crossings(b, a, tolerance);
  if (!a.is_arc()) {
    const Vector2d u = a.end - a.start;
    const Vector2d v = b.end - b.start;
    const double sine = cross(u, v);
    if (sine == 0) return {};
    return {a.start + cross(b.start - a.start, v) / sine * u};
  }
  if (!b.is_arc()) {
    const Vector2d normal = to_the_left(b.end - b.start).normalized();
    return ends_of_chord(a, normal.dot(b.start - a.centre), normal, tolerance);
  }
  const Vector2d between = b.centre - a.centre;
  const double distance = between.norm();
  if (distance <= tolerance) return {};
  const double foot = (distance * distance + a.radius * a.radius - b.radius * b.radius) / (2 * distance);
  // Near a touch the foot moves much for a small change of the radii. The gap says whether they touch.
  const double gap =
      std::min(std::abs(distance - a.radius - b.radius), std::abs(distance - std::abs(a.radius - b.radius)));
  if (gap <= tolerance) return {a.centre + std::copysign(a.radius, foot) * between / distance};
  return ends_of_chord(a, foot, between / distance, 0);
}

double ProfileSegment::length() const {
  return is_arc() ? std::abs(angle) * radius : (end - start).norm();
}

Vector2d ProfileSegment::at(double share) const {
  if (!is_arc()) return start + share * (end - start);
  return centre + turned(start - centre, share * angle);
}

Vector2d ProfileSegment::normal(double share) const {
  if (!is_arc()) return -to_the_left(end - start).normalized();
  return turned(start - centre, share * angle) / std::copysign(radius, bulge);
}

bool ProfileSegment::is_left(const Vector2d& point) const {
  const Vector2d along = end - start;
  const double side = cross(along, point - start);
  if (side != 0) return side > 0;
  return along.y() != 0 ? along.y() < 0 : along.x() > 0;
}

double ProfileSegment::first_moment() const {
  if (!is_arc()) return length() * 0.5 * (start.x() + end.x());
  return radius * (centre.x() * std::abs(angle) + std::copysign(end.y() - start.y(), angle * (end.y() - start.y())));
}

std::vector<ProfileSegment> segments_of(const ClosedPath& path) {
  std::vector<ProfileSegment> segments;
  segments.reserve(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    segments.push_back(segment_between(path[i].point, path[i].bulge, path[(i + 1) % path.size()].point));
  }
  return segments;
}

std::vector<ProfileRegion> regions_of(const Profile& profile) {
  std::vector<std::vector<ProfileSegment>> paths;
  for (const ClosedPath& path : profile.paths) paths.push_back(segments_of(path));
  // Any place of a path tells what is around it, since paths do not touch.
  std::vector<std::vector<std::size_t>> around(paths.size());  // by path: the paths that are around it
  for (std::size_t outer = 0; outer < paths.size(); ++outer) {
    const Eigen::AlignedBox2d box = bounds_of(paths[outer]);
    for (std::size_t inner = 0; inner < paths.size(); ++inner) {
      const Vector2d& place = paths[inner].front().start;
      if (outer != inner && box.contains(place) && is_inside(paths[outer], place)) around[inner].push_back(outer);
    }
  }
  const auto turning = [&](std::size_t p, bool left) {
    return (doubled_area(paths[p]) > 0) == left ? paths[p] : reversed(paths[p]);
  };
  std::vector<ProfileRegion> regions;
  for (std::size_t outer = 0; outer < paths.size(); ++outer) {
    if (around[outer].size() % 2 == 1) continue;
    ProfileRegion& region = regions.emplace_back(ProfileRegion{.outline = turning(outer, true), .holes = {}});
    for (std::size_t inner = 0; inner < paths.size(); ++inner) {
      if (around[inner].size() != around[outer].size() + 1) continue;
      if (std::ranges::find(around[inner], outer) != around[inner].end()) region.holes.push_back(turning(inner, false));
    }
  }
  return regions;
}

std::vector<ProfileSegment> segments_of(const Profile& profile) {
  std::vector<ProfileSegment> all;
  for (const ProfileRegion& region : regions_of(profile)) {
    all.insert(all.end(), region.outline.begin(), region.outline.end());
    for (const auto& hole : region.holes) all.insert(all.end(), hole.begin(), hole.end());
  }
  return all;
}

bool is_inside(std::span<const ProfileSegment> segments, const Vector2d& point) {
  bool inside = false;
  for (const ProfileSegment& s : segments) {
    const bool is_left = s.is_left(point);
    const bool spans = (s.start.y() <= point.y()) != (s.end.y() <= point.y());
    if (spans && is_left == (s.end.y() > s.start.y())) inside = !inside;
    // An arc adds or takes the circular segment beside its chord.
    if (s.is_arc() && is_left == (s.bulge < 0) && (point - s.centre).norm() < s.radius) inside = !inside;
  }
  return inside;
}

const Profile* profile_of(const Shape& shape) {
  if (const auto* extrusion = std::get_if<Extrusion>(&shape)) return &extrusion->profile;
  if (const auto* revolution = std::get_if<Revolution>(&shape)) return &revolution->profile;
  return nullptr;
}

std::size_t count_segments(const Profile& profile) {
  std::size_t count = 0;
  for (const ClosedPath& path : profile.paths) count += is_circle(segments_of(path)) ? 1 : path.size();
  return count;
}

std::size_t count_corners(const Profile& profile) {
  std::size_t count = 0;
  for (const ClosedPath& path : profile.paths) count += path.size();
  return count;
}

double angle_from_start(const ProfileSegment& arc, const Vector2d& direction) {
  const Vector2d from = arc.start - arc.centre;
  const double angle = std::atan2(cross(from, direction), from.dot(direction));
  if (arc.angle > 0 && angle < 0) return angle + 2 * pi;
  if (arc.angle < 0 && angle > 0) return angle - 2 * pi;
  return angle;
}

bool is_circle(std::span<const ProfileSegment> path) {
  constexpr double k_equal = 1e-9;  // in radii
  const ProfileSegment& first = path.front();
  return std::ranges::all_of(path, [&](const ProfileSegment& s) {
    return s.is_arc() && (s.bulge > 0) == (first.bulge > 0) &&
           std::abs(s.radius - first.radius) <= k_equal * first.radius &&
           (s.centre - first.centre).norm() <= k_equal * first.radius;
  });
}

double doubled_area(std::span<const ProfileSegment> segments) {
  double sum = 0;
  for (const ProfileSegment& s : segments) {
    sum += cross(s.start - segments.front().start, s.end - s.start);  // exact far from the origin, too
    if (s.is_arc()) sum += s.radius * s.radius * (s.angle - std::sin(s.angle));
  }
  return sum;
}

double area_of(const Profile& profile) {
  return 0.5 * doubled_area(segments_of(profile));
}

std::pair<double, double> extent_along(const ProfileSegment& segment, const Vector2d& direction) {
  auto [low, high] = std::minmax({direction.dot(segment.start), direction.dot(segment.end)});
  if (segment.is_arc()) {
    const double middle = direction.dot(segment.centre);
    const double reach = segment.radius * direction.norm();
    if (is_in_sector(segment, direction)) high = std::max(high, middle + reach);
    if (is_in_sector(segment, -direction)) low = std::min(low, middle - reach);
  }
  return {low, high};
}

std::pair<double, double> extent_along(const Profile& profile, const Vector2d& direction) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const ClosedPath& path : profile.paths) {
    for (const ProfileSegment& segment : segments_of(path)) {
      const auto [least, most] = extent_along(segment, direction);
      low = std::min(low, least);
      high = std::max(high, most);
    }
  }
  return {low, high};
}

Eigen::AlignedBox2d bounds_of(std::span<const ProfileSegment> segments) {
  Eigen::AlignedBox2d box;
  for (const ProfileSegment& segment : segments) {
    const auto [low_x, high_x] = extent_along(segment, Vector2d::UnitX());
    const auto [low_y, high_y] = extent_along(segment, Vector2d::UnitY());
    box.extend(Vector2d(low_x, low_y)).extend(Vector2d(high_x, high_y));
  }
  return box;
}

Eigen::AlignedBox2d bounds_of(const Profile& profile) {
  Eigen::AlignedBox2d box;
  for (const ClosedPath& path : profile.paths) box.extend(bounds_of(segments_of(path)));
  return box;
}

bool is_in_sector(const ProfileSegment& arc, const Vector2d& direction) {
  const Vector2d first = (arc.angle > 0 ? arc.start : arc.end) - arc.centre;
  double angle = std::atan2(cross(first, direction), first.dot(direction));
  if (angle < 0) angle += 2 * pi;
  return angle <= std::abs(arc.angle);
}

}  // namespace cloud2csg
