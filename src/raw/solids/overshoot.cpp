#include "raw/solids/overshoot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "core/primitive/profile.hpp"
#include "raw/solids/outline.hpp"
#include "raw/solids/simplest_solid.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Whether a profile may contain a place or not without a difference.
using IsFree = std::function<bool(const Vector2d&)>;

constexpr double k_most = 0.01;                        // in diagonals of the part
constexpr std::array k_shares{1.0, 0.5, 0.25, 0.125};  // of the most; the first that is free is taken
constexpr int k_probes_across = 4;                     // in the strip between both segments

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
  Overshooting(const IsFree& is_free, bool is_turned, double most, std::vector<ProfileSegment> path)
      : is_free_(is_free),
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
    for (const double share : k_shares) {
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
    for (const double share : k_shares) {
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
      const Vector2d from = *start - curve.centre;
      const Vector2d to = *end - curve.centre;
      double angle = std::atan2(cross(from, to), from.dot(to));
      if (curve.angle > 0 && angle < 0) angle += 2 * std::numbers::pi;
      if (curve.angle < 0 && angle > 0) angle -= 2 * std::numbers::pi;
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
    const auto count = static_cast<int>(std::ceil(std::max(exact.length(), moved.length()) / most_));
    for (int i = 0; i <= count; ++i) {
      const double share = static_cast<double>(i) / count;
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
  double most_;
  bool is_turned_;
  std::vector<ProfileSegment> exact_;   // as the faces have it
  std::vector<ProfileSegment> curves_;  // of the moved segments, not cut off
  std::vector<ProfileSegment> moved_;
  std::vector<double> distance_;  // by which a segment moved
};

/// The profile with those segments farther out that have only free places beside them, in the same order; absent if
/// none has.
std::optional<Profile> with_free_segments_out(const Profile& outline, bool is_turned, double most,
                                              const IsFree& is_free) {
  Profile moved;
  bool is_moved = false;
  for (const ClosedPath& path : outline.paths) {
    Overshooting overshooting(is_free, is_turned, most, segments_of(path));
    is_moved = overshooting.move() || is_moved;
    moved.paths.push_back(overshooting.path());
  }
  return is_moved && is_valid(moved, is_turned) ? std::optional(std::move(moved)) : std::nullopt;
}

/// A box as an extrusion, a cylinder or cone as a revolution; other solids as they are.
Primitive as_swept(Primitive solid) {
  const auto turn = [&solid](double bottom, double top, double height) {
    ClosedPath path{{.point = {0, -0.5 * height}}};
    if (bottom > 0) path.push_back({.point = {bottom, -0.5 * height}});
    if (top > 0) path.push_back({.point = {top, 0.5 * height}});
    path.push_back({.point = {0, 0.5 * height}});
    solid.shape = Revolution{{.paths = {path}}};
  };
  if (const auto* box = std::get_if<Box>(&solid.shape)) {
    const Vector2d half = 0.5 * box->size.head<2>();
    const double height = box->size.z();
    const ClosedPath path{
        {.point = -half}, {.point = {half.x(), -half.y()}}, {.point = half}, {.point = {-half.x(), half.y()}}};
    solid.shape = Extrusion{.profile = {.paths = {path}}, .height = height};
  } else if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape)) {
    turn(cylinder->radius, cylinder->radius, cylinder->height);
  } else if (const auto* cone = std::get_if<Cone>(&solid.shape)) {
    turn(cone->radius_bottom, cone->radius_top, cone->height);
  }
  return solid;
}

/// Where an extrusion lies within the box: its least and greatest local z.
std::pair<double, double> heights_within(const Extrusion& extrusion, const Pose& pose, const AlignedBox& box) {
  const Vector3d axis = pose.orientation * Vector3d::UnitZ();
  const double middle = (box.center() - pose.position).dot(axis);
  const double half = 0.5 * box.sizes().dot(axis.cwiseAbs());
  return {std::max(middle - half, -0.5 * extrusion.height), std::min(middle + half, 0.5 * extrusion.height)};
}

/// A grid of places in the profile.
std::vector<Vector2d> places_in(const Profile& profile, double step) {
  const std::vector<ProfileSegment> segments = segments_of(profile);
  const Eigen::AlignedBox2d box = bounds_of(segments);
  const auto count = [&](Eigen::Index axis) { return static_cast<int>(std::ceil(box.sizes()[axis] / step)); };
  std::vector<Vector2d> places;
  for (int i = 0; i < count(0); ++i) {
    for (int j = 0; j < count(1); ++j) {
      const Vector2d share((i + 0.5) / count(0), (j + 0.5) / count(1));
      const Vector2d place = box.min() + share.cwiseProduct(box.sizes());
      if (is_inside(segments, place)) places.push_back(place);
    }
  }
  return places;
}

/// Points of an extrusion, within the box, or of a revolution at one place of its profile, `step` apart.
Points points_at(const Primitive& solid, const Vector2d& place, const AlignedBox& box, double step) {
  const auto* const extrusion = std::get_if<Extrusion>(&solid.shape);
  const auto [low, high] = extrusion != nullptr ? heights_within(*extrusion, solid.pose, box)
                                                : std::pair(0.0, 2 * std::numbers::pi * place.x());
  Points points;
  const auto count = static_cast<int>(std::max(std::ceil((high - low) / step), 1.0));
  for (int k = 0; k < count; ++k) {
    const double along = low + (k + 0.5) / count * (high - low);
    const double angle = place.x() > 0 ? along / place.x() : 0;
    points.push_back(solid.pose.to_world(
        extrusion == nullptr ? Vector3d(place.x() * std::cos(angle), place.x() * std::sin(angle), place.y())
                             : Vector3d(place.x(), place.y(), along)));
  }
  return points;
}

/// Tells where the tree is the same with and without a solid.
class Indifference {
 public:
  Indifference(const PrimitiveSet& solids, const CsgTree& tree)
      : solids_(solids), tree_(tree), used_(primitives_of(tree)) {
    for (const Primitive& solid : solids) bounds_.push_back(bounds(solid));
  }

  [[nodiscard]] bool holds_at(const Points& points, PrimitiveIndex solid) const {
    const AlignedBox box = bounds_of(points);
    std::vector<std::vector<bool>> is_inside(points.size(), std::vector<bool>(solids_.size()));
    for (const PrimitiveIndex other : used_) {
      if (other == solid || !bounds_[other].intersects(box)) continue;
      const std::vector<double> distances = signed_distance(solids_[other], points);
      for (std::size_t i = 0; i < points.size(); ++i) is_inside[i][other] = distances[i] < 0;
    }
    return std::ranges::all_of(is_inside, [&](std::vector<bool>& inside) {
      const bool without = contains(tree_, inside);
      inside[solid] = true;
      return contains(tree_, inside) == without;
    });
  }

 private:
  const PrimitiveSet& solids_;
  const CsgTree& tree_;
  std::vector<PrimitiveIndex> used_;
  std::vector<AlignedBox> bounds_ = {};
};

/// Makes one solid overshoot.
class SolidOvershoot {
 public:
  SolidOvershoot(const Primitive& solid, const AlignedBox& part, const std::function<bool(const Points&)>& is_free)
      : solid_(as_swept(solid)), part_(part), most_(k_most * part.diagonal().norm()), is_free_(is_free) {}

  /// Absent if it stays as it is.
  std::optional<Primitive> solid() {
    bool is_moved = false;
    if (auto* const extrusion = std::get_if<Extrusion>(&solid_.shape)) {
      is_moved = move_outline(extrusion->profile, false);
      for (const double end : {-1.0, 1.0}) is_moved = move_end(*extrusion, end) || is_moved;
    } else if (auto* const revolution = std::get_if<Revolution>(&solid_.shape)) {
      is_moved = move_outline(revolution->profile, true);
    }
    return is_moved ? std::optional(simplest(solid_)) : std::nullopt;
  }

 private:
  bool move_outline(Profile& profile, bool is_turned) {
    std::optional<Profile> moved = with_free_segments_out(profile, is_turned, most_, [&](const Vector2d& place) {
      return is_free_(points_at(solid_, place, part_, most_));
    });
    if (moved) profile = std::move(*moved);
    return moved.has_value();
  }

  bool move_end(Extrusion& extrusion, double end) {
    const std::vector<Vector2d> places = places_in(extrusion.profile, most_);
    for (const double share : k_shares) {
      const double by = share * most_;
      Points points;
      for (const Vector2d& place : places) {
        for (int k = 1; k <= k_probes_across; ++k) {
          const double height = 0.5 * extrusion.height + by * k / k_probes_across;
          points.push_back(solid_.pose.to_world({place.x(), place.y(), end * height}));
        }
      }
      if (points.empty() || !is_free_(points)) continue;
      extrusion.height += by;
      solid_.pose.position += solid_.pose.orientation * Vector3d(0, 0, 0.5 * end * by);
      return true;
    }
    return false;
  }

  Primitive solid_;
  const AlignedBox& part_;
  double most_;
  const std::function<bool(const Points&)>& is_free_;
};

}  // namespace

PrimitiveSet with_overshoots(PrimitiveSet solids, const CsgTree& tree, std::size_t fixed, const AlignedBox& part) {
  for (const PrimitiveIndex index : primitives_of(tree)) {
    if (index < fixed || !is_plain(solids[index])) continue;
    const Indifference indifference(solids, tree);
    const std::function<bool(const Points&)> is_free = [&](const Points& points) {
      return indifference.holds_at(points, index);
    };
    if (std::optional<Primitive> moved = SolidOvershoot(solids[index], part, is_free).solid()) {
      solids[index].shape = std::move(moved->shape);
      solids[index].pose = moved->pose;
    }
  }
  return solids;
}

}  // namespace cloud2csg
