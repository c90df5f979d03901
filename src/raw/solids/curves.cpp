#include "raw/solids/curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "raw/solids/arrangement.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;

constexpr double k_least_arc_reach = 0.35;  // beyond the points of a circle, in radians

/// The place on a curve that is nearest to a circle beside or inside it.
std::optional<Vector2d> nearest_place(const Curve& curve, const Curve& circle) {
  if (!curve.is_circle) return circle.normal + (curve.offset - curve.normal.dot(circle.normal)) * curve.normal;
  const Vector2d arm = circle.normal - curve.normal;
  if (arm.norm() <= 1e-9 * curve.offset) return std::nullopt;
  return curve.normal + curve.offset * arm.normalized();
}

double circumference(const Curve& circle) {
  return 2 * std::numbers::pi * circle.offset;
}

/// The part with points; of a circle, all but the largest gap.
CurveExtent supported_part(const Curve& curve) {
  std::vector<double> along;
  for (const Vector2d& p : curve.points) along.push_back(curve.along(p));
  std::ranges::sort(along);
  if (!curve.is_circle) return {along.front(), along.back()};
  const double around = circumference(curve);
  double gap = along.front() + around - along.back();
  double start = along.front();
  for (std::size_t k = 1; k < along.size(); ++k) {
    if (along[k] - along[k - 1] <= gap) continue;
    gap = along[k] - along[k - 1];
    start = along[k];
  }
  return {start, start + around - gap};
}

CurveExtent with_reach(const Curve& curve, CurveExtent part, double reach) {
  const double more = curve.is_circle ? std::max(reach, k_least_arc_reach * curve.offset) : reach;
  return {part.low - more, part.high + more};
}

/// The whole line or circle, for crossings().
ProfileSegment whole(const Curve& curve) {
  return pieces_of(curve, {0, curve.is_circle ? 0.5 * circumference(curve) : 1.0})[0];
}

/// How far a place on the curve is beyond the end of a part, negative before it. On a circle, a place is before the
/// nearer end.
double way_beyond(const Curve& curve, const CurveExtent& part, bool is_high, const Vector2d& place) {
  const double along = curve.along(place);
  if (!curve.is_circle) return is_high ? along - part.high : part.low - along;
  const double around = circumference(curve);
  double beyond = std::fmod(is_high ? along - part.high : part.low - along, around);
  if (beyond < 0) beyond += around;
  const double length = part.high - part.low;
  return beyond > around - 0.5 * length ? beyond - around : beyond;
}

/// How far a place on the curve is from a part; 0 in it.
double way_to(const Curve& curve, const CurveExtent& part, const Vector2d& place) {
  if (!curve.is_circle) {
    const double along = curve.along(place);
    return std::max({part.low - along, along - part.high, 0.0});
  }
  return std::max(std::min(way_beyond(curve, part, true, place), way_beyond(curve, part, false, place)), 0.0);
}

/// Lets curves go on to each other.
class Extender {
 public:
  Extender(std::span<const Curve> curves, double reach) : curves_(curves), reach_(reach) {
    for (const Curve& curve : curves) {
      wholes_.push_back(whole(curve));
      parts_.push_back(supported_part(curve));
      extents_.push_back(with_reach(curve, parts_.back(), reach));
    }
    near_ = extents_;
  }

  std::vector<CurveExtent> extents() {
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      if (curves_[c].count == 0) continue;
      for (const bool is_high : {false, true}) extend(c, is_high);
    }
    return std::move(extents_);
  }

 private:
  struct Meeting {
    std::size_t other = 0;
    Vector2d place = Vector2d::Zero();
    double way = std::numeric_limits<double>::infinity();  ///< by which both grow
  };

  void extend(std::size_t c, bool is_high) {
    Meeting best;
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      if (k == c || curves_[k].count == 0) continue;
      for (const Vector2d& place : crossings(wholes_[c], wholes_[k], 0)) {
        const double beyond = way_beyond(curves_[c], parts_[c], is_high, place);
        const double to_other = way_to(curves_[k], near_[k], place);
        if (beyond < -reach_) continue;
        if (beyond <= reach_ && to_other == 0) return;  // they meet
        if (std::max(beyond, 0.0) + to_other < best.way) best = {k, place, std::max(beyond, 0.0) + to_other};
      }
    }
    if (!std::isfinite(best.way)) return;
    grow(c, best.place);
    grow(best.other, best.place);
  }

  /// To the place and a little more.
  void grow(std::size_t c, const Vector2d& place) {
    constexpr double k_more = 0.1;  // of the reach
    CurveExtent& extent = extents_[c];
    const double low = way_beyond(curves_[c], near_[c], false, place);
    const double high = way_beyond(curves_[c], near_[c], true, place);
    if (way_to(curves_[c], near_[c], place) == 0) return;
    const bool is_high = curves_[c].is_circle ? high < low : high > low;
    if (is_high) {
      extent.high = std::max(extent.high, near_[c].high + high + k_more * reach_);
    } else {
      extent.low = std::min(extent.low, near_[c].low - low - k_more * reach_);
    }
  }

  std::span<const Curve> curves_;
  double reach_;
  std::vector<ProfileSegment> wholes_ = {};
  std::vector<CurveExtent> parts_ = {};           // with points
  std::vector<CurveExtent> near_, extents_ = {};  // with the reach, and what they grow to
};

std::vector<ProfileSegment> whole_pieces_of(const Curve& curve, const CurveExtent& extent) {
  if (!curve.is_circle) {
    const Vector2d direction = to_the_left(curve.normal);
    const Vector2d foot = curve.offset * curve.normal;
    return {segment_between(foot + extent.low * direction, 0, foot + extent.high * direction)};
  }
  const double around = circumference(curve);
  constexpr double k_nearly_whole = 0.95;
  const double length = extent.high - extent.low > k_nearly_whole * around ? around : extent.high - extent.low;
  const auto at = [&](double share) {
    const double angle = (extent.low + share * length) / curve.offset;
    return Vector2d(curve.normal + curve.offset * Vector2d(std::cos(angle), std::sin(angle)));
  };
  const double bulge = std::tan(length / curve.offset / 8);  // of a half
  return {segment_between(at(0), bulge, at(0.5)), segment_between(at(0.5), bulge, at(1))};
}

/// The parts of a piece with x >= 0.
std::vector<ProfileSegment> right_of_axis(const ProfileSegment& piece) {
  std::vector<double> shares{0, 1};
  for (const Vector2d& place : crossings(piece, segment_between({0, 0}, 0, {0, 1}), 0)) {
    const double share = share_of(piece, place);
    if (share > 0 && share < 1) shares.push_back(share);
  }
  if (shares.size() == 2) return piece.at(0.5).x() < 0 ? std::vector<ProfileSegment>() : std::vector{piece};
  std::ranges::sort(shares);
  std::vector<ProfileSegment> parts;
  for (std::size_t k = 1; k < shares.size(); ++k) {
    if (piece.at(0.5 * (shares[k - 1] + shares[k])).x() < 0) continue;
    const auto end = [&](double share) {
      const Vector2d place = piece.at(share);
      return share > 0 && share < 1 ? Vector2d(0, place.y()) : place;
    };
    const double bulge = std::tan((shares[k] - shares[k - 1]) * piece.angle / 4);
    parts.push_back(segment_between(end(shares[k - 1]), bulge, end(shares[k])));
  }
  return parts;
}

}  // namespace

bool is_same(const Curve& a, const Curve& b, double tolerance) {
  if (a.is_circle != b.is_circle) return false;
  if (a.is_circle) return (a.normal - b.normal).norm() < tolerance && std::abs(a.offset - b.offset) < tolerance;
  // A line is what it is near the other's points.
  return std::abs(a.normal.dot(b.normal)) > 0.999 &&
         std::ranges::all_of(b.points, [&](const Vector2d& p) { return a.distance(p) < 2 * tolerance; });
}

std::vector<Curve> merged(std::vector<Curve> curves, double tolerance) {
  std::ranges::stable_sort(curves, std::greater<>(), &Curve::count);
  std::vector<Curve> result;
  for (Curve& curve : curves) {
    const auto known =
        std::ranges::find_if(result, [&](const Curve& other) { return is_same(other, curve, tolerance); });
    if (known == result.end()) {
      result.push_back(std::move(curve));
    } else {
      known->points.insert(known->points.end(), curve.points.begin(), curve.points.end());
      known->count += curve.count;
    }
  }
  return result;
}

std::vector<Curve> with_closed_gaps(std::vector<Curve> curves, double reach, double tolerance) {
  std::vector<std::vector<ProfileSegment>> pieces;
  pieces.reserve(curves.size());
  for (const Curve& curve : curves) {
    pieces.push_back(pieces_of(curve, with_reach(curve, supported_part(curve), reach)));
  }
  const auto is_on = [&](std::size_t c, const Vector2d& place) {
    return std::ranges::any_of(
        pieces[c], [&](const ProfileSegment& piece) { return (nearest(piece, place) - place).norm() <= tolerance; });
  };
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (!curves[c].is_circle) continue;
    double most = 0;
    for (std::size_t k = 0; k < curves.size(); ++k) {
      const std::optional<Vector2d> place = k == c ? std::nullopt : nearest_place(curves[k], curves[c]);
      if (!place) continue;
      const double gap = (*place - curves[c].normal).norm() - curves[c].offset;
      if (gap > most && gap <= tolerance && is_on(c, *place) && is_on(k, *place)) most = gap;
    }
    curves[c].offset += most;
  }
  return curves;
}

std::vector<CurveExtent> extents_of(std::span<const Curve> curves, double reach) {
  return Extender(curves, reach).extents();
}

std::vector<ProfileSegment> pieces_of(const Curve& curve, const CurveExtent& extent, bool is_turned) {
  std::vector<ProfileSegment> pieces = whole_pieces_of(curve, extent);
  if (!is_turned) return pieces;
  std::vector<ProfileSegment> parts;
  for (const ProfileSegment& piece : pieces) {
    for (const ProfileSegment& part : right_of_axis(piece)) parts.push_back(part);
  }
  return parts;
}

Eigen::AlignedBox2d with_ends_of_circles(const Eigen::AlignedBox2d& seen, std::span<const Curve> curves,
                                         double tolerance) {
  Eigen::AlignedBox2d grown = seen;
  for (const Curve& curve : curves) {
    if (!curve.is_circle) continue;
    for (const Vector2d& way : {Vector2d(1, 0), Vector2d(0, 1), Vector2d(-1, 0), Vector2d(0, -1)}) {
      const Vector2d end = curve.normal + curve.offset * way;
      const double near = k_least_arc_reach * curve.offset;
      const auto is_near = [&](const Vector2d& p) { return (p - end).norm() < near; };
      if (seen.exteriorDistance(end) <= tolerance && std::ranges::any_of(curve.points, is_near)) grown.extend(end);
    }
  }
  return grown;
}

double bare_length(const ProfileSegment& piece, const Curve& curve, double near) {
  if (curve.count == 0) return piece.length();
  constexpr std::array k_probes{0.1, 0.3, 0.5, 0.7, 0.9};
  std::size_t bare = 0;
  for (const double share : k_probes) {
    const Vector2d probe = piece.at(share);
    bare += std::ranges::none_of(curve.points, [&](const Vector2d& p) { return (p - probe).norm() < near; }) ? 1 : 0;
  }
  return piece.length() * static_cast<double>(bare) / k_probes.size();
}

}  // namespace cloud2csg
