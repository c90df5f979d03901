#include "raw/solids/overshooting_outline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "raw/solids/outline.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;

/// Shares of a segment's length, likewise.
std::vector<double> shares_along(const ProfileSegment& segment, const Levels& levels, double step) {
  std::vector<double> cuts;
  for (Eigen::Index axis = 0; axis < 2 && !segment.is_arc(); ++axis) {
    const double way = segment.end[axis] - segment.start[axis];
    if (std::abs(way) <= 1e-9 * segment.length()) continue;
    for (const double level : levels[static_cast<std::size_t>(axis)])
      cuts.push_back((level - segment.start[axis]) / way);
  }
  return positions_between(0, 1, cuts, step / segment.length());
}

/// The whole curve, that much farther out; absent if a circle vanishes.
std::optional<ProfileSegment> moved_out(ProfileSegment segment, double by) {
  if (!segment.is_arc()) {
    const Vector2d shift = by * segment.normal(0.5);
    return segment_between(segment.start + shift, 0, segment.end + shift);
  }
  const double grown = segment.angle > 0 ? segment.radius + by : segment.radius - by;
  if (!(grown > 0)) return std::nullopt;
  for (Vector2d* end : {&segment.start, &segment.end}) {
    *end = segment.centre + grown / segment.radius * (*end - segment.centre);
  }
  segment.radius = grown;
  return segment;
}

class Overshooting {
 public:
  Overshooting(const IsFree& is_free, const Levels& levels, bool is_turned, double most,
               std::vector<ProfileSegment> path)
      : is_free_(is_free),
        levels_(levels),
        most_(most),
        is_turned_(is_turned),
        exact_(std::move(path)),
        curves_(exact_),
        moved_(exact_),
        distance_(exact_.size(), 0.0) {}

  /// Returns whether any segment moved.
  bool move() {
    if (is_circle(exact_)) return move_circle();
    bool is_moved = false;
    for (std::size_t k = 0; k < exact_.size(); ++k) is_moved = move(k) || is_moved;
    return is_moved;
  }

  [[nodiscard]] ClosedPath path() const {
    ClosedPath result;
    for (const ProfileSegment& s : moved_) result.push_back({.point = s.start, .bulge = s.bulge});
    return result;
  }

 private:
  bool move_circle() {
    for (const double share : k_overshoot_shares) {
      std::vector<ProfileSegment> halves;
      for (const ProfileSegment& half : exact_) {
        const std::optional<ProfileSegment> out = moved_out(half, share * most_);
        if (out && is_free_between(half, *out)) halves.push_back(*out);
      }
      if (halves.size() != exact_.size()) continue;
      moved_ = std::move(halves);
      return true;
    }
    return false;
  }

  /// Moves a segment and the ends of its neighbours.
  bool move(std::size_t k) {
    if (is_turned_ && exact_[k].is_on_axis()) return false;
    const std::size_t before = (k + exact_.size() - 1) % exact_.size();
    const std::size_t after = (k + 1) % exact_.size();
    const std::vector<ProfileSegment> curves = curves_;
    const std::vector<ProfileSegment> moved = moved_;
    for (const double share : k_overshoot_shares) {
      const std::optional<ProfileSegment> out = moved_out(exact_[k], share * most_);
      if (!out) continue;
      curves_[k] = *out;
      distance_[k] = share * most_;
      if (fit(before) && fit(k) && fit(after)) return true;
      curves_ = curves;
      moved_ = moved;
      distance_[k] = 0;
    }
    return false;
  }

  /// Cuts the curve off at both neighbours. Returns whether it then passes free faces only.
  bool fit(std::size_t k) {
    const std::optional<Vector2d> start = corner(k);
    const std::optional<Vector2d> end = corner((k + 1) % exact_.size());
    if (!start || !end || *start == *end) return false;
    const ProfileSegment& curve = curves_[k];
    double bulge = 0;
    if (curve.is_arc()) {
      ProfileSegment cut = curve;
      cut.start = *start;
      const double angle = angle_from_start(cut, *end - curve.centre);
      if (std::abs(angle - curve.angle) > std::numbers::pi) return false;
      bulge = std::tan(angle / 4);
    } else if ((*end - *start).dot(curve.end - curve.start) <= 0) {
      return false;
    }
    moved_[k] = segment_between(*start, bulge, *end);
    // A segment that only becomes longer sweeps no area.
    return distance_[k] == 0 || is_free_between(exact_[k], moved_[k]);
  }

  /// Where a segment starts: at its old place if nothing moved there.
  [[nodiscard]] std::optional<Vector2d> corner(std::size_t k) const {
    const std::size_t before = (k + exact_.size() - 1) % exact_.size();
    const Vector2d old = exact_[k].start;
    const double moved = std::max(distance_[before], distance_[k]);
    if (moved == 0) return old;
    const std::vector<Vector2d> places = crossings(curves_[before], curves_[k], 0);
    const auto nearest = std::ranges::min_element(places, {}, [&](const Vector2d& p) { return (p - old).norm(); });
    // Curves that meet at a sharp angle would go on far.
    constexpr double k_most_stretch = 4;
    if (nearest == places.end() || (*nearest - old).norm() > k_most_stretch * moved) return std::nullopt;
    if (is_turned_ && nearest->x() < 0) return std::nullopt;
    return *nearest;
  }

  [[nodiscard]] bool is_free_between(const ProfileSegment& exact, const ProfileSegment& moved) const {
    for (const double share : shares_along(moved, levels_, most_)) {
      const Vector2d from = exact.at(share);
      const Vector2d arm = moved.at(share) - from;
      if (arm.isZero(0)) continue;
      for (int j = 1; j <= k_probes_across; ++j) {
        const double across = static_cast<double>(j) / k_probes_across;
        if (!is_free_(from + across * arm)) return false;
      }
    }
    return true;
  }

  const IsFree& is_free_;
  const Levels& levels_;
  double most_;
  bool is_turned_;
  std::vector<ProfileSegment> exact_;   // as the faces have it
  std::vector<ProfileSegment> curves_;  // of the moved segments, not cut off
  std::vector<ProfileSegment> moved_;
  std::vector<double> distance_;  // by which a segment moved
};

}  // namespace

std::vector<double> positions_between(double low, double high, const std::vector<double>& levels, double step) {
  std::vector<double> cuts{low, high};
  for (const double level : levels) {
    if (level > low && level < high) cuts.push_back(level);
  }
  std::ranges::sort(cuts);
  std::vector<double> positions;
  for (std::size_t k = 1; k < cuts.size(); ++k) {
    const double length = cuts[k] - cuts[k - 1];
    constexpr double k_rounding = 1e-6;  // in steps
    if (!(length > k_rounding * step)) continue;
    const auto count = static_cast<int>(std::ceil(length / step));
    for (int i = 0; i < count; ++i) positions.push_back(cuts[k - 1] + (i + 0.5) / count * length);
  }
  return positions;
}

std::optional<Profile> with_free_segments_out(const Profile& outline, bool is_turned, double most, const Levels& levels,
                                              const IsFree& is_free) {
  Profile moved;
  bool is_moved = false;
  const auto add = [&](std::vector<ProfileSegment> path) {
    Overshooting overshooting(is_free, levels, is_turned, most, std::move(path));
    is_moved = overshooting.move() || is_moved;
    moved.paths.push_back(overshooting.path());
  };
  for (ProfileRegion& region : regions_of(outline)) {
    add(std::move(region.outline));
    for (std::vector<ProfileSegment>& hole : region.holes) add(std::move(hole));
  }
  return is_moved && is_valid(moved, is_turned) ? std::optional(std::move(moved)) : std::nullopt;
}

}  // namespace cloud2csg
