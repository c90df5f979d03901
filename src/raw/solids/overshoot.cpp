#include "raw/solids/overshoot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/geometry/boxes.hpp"
#include "core/primitive/profile.hpp"
#include "core/primitive/shape.hpp"
#include "raw/solids/overshooting_outline.hpp"
#include "raw/solids/simplest_solid.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double k_most = 0.01;  // in diagonals of the part
/// In greatest overshoots: an end shares a face with another solid that is as near. The face of a solid that was moved
/// before is farther away, and the end stays.
constexpr double k_shared = 0.1;

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
  const auto [low, high] = extent_along(box, pose.position, pose.orientation * Vector3d::UnitZ());
  return {std::max(low, -0.5 * extrusion.height), std::min(high, 0.5 * extrusion.height)};
}

/// A grid of places in the profile.
std::vector<Vector2d> places_in(const Profile& profile, const Levels& levels, double step) {
  const std::vector<ProfileSegment> segments = segments_of(profile);
  const Eigen::AlignedBox2d box = bounds_of(segments);
  std::vector<Vector2d> places;
  for (const double x : positions_between(box.min().x(), box.max().x(), levels[0], step)) {
    for (const double y : positions_between(box.min().y(), box.max().y(), levels[1], step)) {
      if (is_inside(segments, {x, y})) places.emplace_back(x, y);
    }
  }
  return places;
}

/// Intervals of the angles from 0 to `turn` around the local z at which the circle through the place (r, z) may lie in
/// a ball.
std::vector<std::pair<double, double>> angles_in(const Vector3d& middle, double radius, const Vector2d& place,
                                                 double turn) {
  const double away = middle.head<2>().norm();
  if ((Vector2d(away, middle.z()) - place).norm() > radius) return {};
  if (away <= radius) return {{0, turn}};
  const double angle = std::atan2(middle.y(), middle.x());
  const double half = std::asin(radius / away);
  std::vector<std::pair<double, double>> intervals;
  for (const double turned : {angle, angle + 2 * std::numbers::pi}) {
    const double first = std::max(turned - half, 0.0);
    const double last = std::min(turned + half, turn);
    if (first < last) intervals.emplace_back(first, last);
  }
  return intervals;
}

/// Points of a solid at one place of its profile, around the box, at most `step` apart.
Points points_at(const Primitive& solid, const Vector2d& place, const AlignedBox& box, const Levels& levels,
                 double step) {
  Points points;
  if (const auto* const extrusion = std::get_if<Extrusion>(&solid.shape)) {
    const auto [low, high] = heights_within(*extrusion, solid.pose, box);
    for (const double height : positions_between(low, high, levels[2], step)) {
      points.push_back(solid.pose.to_world({place.x(), place.y(), height}));
    }
    return points;
  }
  const double turn = turn_of(std::get<Revolution>(solid.shape));
  const double radius = 0.5 * box.diagonal().norm() + step;
  for (const auto& [first, last] : angles_in(solid.pose.to_local(box.center()), radius, place, turn)) {
    for (const double angle : positions_between(first, last, {}, step / place.x())) {
      points.push_back(solid.pose.to_world({place.x() * std::cos(angle), place.x() * std::sin(angle), place.y()}));
    }
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

  [[nodiscard]] Levels levels_around(PrimitiveIndex solid) const {
    const Pose& frame = solids_[solid].pose;
    Levels levels;
    for (const PrimitiveIndex other : used_) {
      if (other == solid) continue;
      Primitive seen = solids_[other];
      seen.pose = {.position = frame.to_local(seen.pose.position),
                   .orientation = frame.orientation.conjugate() * seen.pose.orientation};
      const AlignedBox box = bounds(seen);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        for (const double level : {box.min()[axis], box.max()[axis]})
          levels[static_cast<std::size_t>(axis)].push_back(level);
      }
    }
    return levels;
  }

  [[nodiscard]] bool holds_at(const Points& points, PrimitiveIndex solid) const {
    const AlignedBox box = bounds_of(points);
    std::vector<PrimitiveIndex> near;
    std::vector<std::vector<double>> distances;
    for (const PrimitiveIndex other : used_) {
      if (other == solid || !bounds_[other].intersects(box)) continue;
      near.push_back(other);
      distances.push_back(signed_distance(solids_[other], points));
    }
    std::vector<bool> is_inside(solids_.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      // Points follow each other in rows, so most are inside the same solids as the one before.
      bool is_new = i == 0;
      for (std::size_t k = 0; k < near.size(); ++k) {
        if (is_inside[near[k]] == (distances[k][i] < 0)) continue;
        is_inside[near[k]].flip();
        is_new = true;
      }
      if (is_new && !is_same_with_and_without(solid, is_inside)) return false;
    }
    return true;
  }

  /// Whether another solid's surface is between the points and those at the same places in the other list. One between
  /// very few does not count: it goes along the way, as where a bend goes on as a pipe.
  [[nodiscard]] bool has_surface_between(const Points& points, const Points& others, PrimitiveIndex solid) const {
    constexpr double k_few = 0.01;
    const AlignedBox box = bounds_of(points).merged(bounds_of(others));
    return std::ranges::any_of(used_, [&](PrimitiveIndex other) {
      if (other == solid || !bounds_[other].intersects(box)) return false;
      const std::vector<double> here = signed_distance(solids_[other], points);
      const std::vector<double> there = signed_distance(solids_[other], others);
      std::size_t count = 0;
      for (std::size_t i = 0; i < here.size(); ++i) count += (here[i] < 0) != (there[i] < 0) ? 1 : 0;
      return static_cast<double>(count) > k_few * static_cast<double>(here.size());
    });
  }

 private:
  [[nodiscard]] bool is_same_with_and_without(PrimitiveIndex solid, std::vector<bool> is_inside) const {
    is_inside[solid] = false;
    const bool without = contains(tree_, is_inside);
    is_inside[solid] = true;
    return contains(tree_, is_inside) == without;
  }

  const PrimitiveSet& solids_;
  const CsgTree& tree_;
  std::vector<PrimitiveIndex> used_;
  std::vector<AlignedBox> bounds_ = {};
};

/// Makes one solid overshoot.
class SolidOvershoot {
 public:
  SolidOvershoot(const PrimitiveSet& solids, PrimitiveIndex index, const Indifference& others, const AlignedBox& part)
      : index_(index),
        solid_(as_swept(solids[index])),
        others_(others),
        part_(part),
        levels_(others.levels_around(index)),
        most_(k_most * part.diagonal().norm()) {
    // The drawing of a revolution has r and z.
    if (std::holds_alternative<Revolution>(solid_.shape)) levels_ = {{{}, levels_[2], {}}};
  }

  /// Absent if it stays as it is.
  std::optional<Primitive> solid() {
    bool is_moved = false;
    if (auto* const extrusion = std::get_if<Extrusion>(&solid_.shape)) {
      is_moved = move_outline(extrusion->profile, false);
      for (const double end : {-1.0, 1.0}) is_moved = move_end(*extrusion, end) || is_moved;
    } else if (auto* const revolution = std::get_if<Revolution>(&solid_.shape)) {
      is_moved = move_outline(revolution->profile, true);
      for (const double end : {-1.0, 1.0}) {
        if (!is_full_turn(*revolution)) is_moved = move_end(*revolution, end) || is_moved;
      }
    }
    return is_moved ? std::optional(simplest(solid_)) : std::nullopt;
  }

 private:
  [[nodiscard]] bool is_free(const Points& points) const { return others_.holds_at(points, index_); }

  bool move_outline(Profile& profile, bool is_turned) {
    std::optional<Profile> moved = with_free_segments_out(
        profile, is_turned, most_, levels_,
        [&](const Vector2d& place) { return is_free(points_at(solid_, place, part_, levels_, most_)); });
    if (moved) profile = std::move(*moved);
    return moved.has_value();
  }

  /// How far to move an end of a swept profile out. Absent if it shares no face with another solid, or if the space
  /// beyond is not free. `beyond(place, by)` is the place of the profile so far beyond the end.
  template <class Beyond>
  [[nodiscard]] std::optional<double> overshoot_of(const Profile& profile, const Beyond& beyond) const {
    const std::vector<Vector2d> places = places_in(profile, levels_, most_);
    const auto points_beyond = [&](double by) {
      Points points;
      for (const Vector2d& place : places) points.push_back(solid_.pose.to_world(beyond(place, by)));
      return points;
    };
    const double near = k_shared * most_;
    if (places.empty() || !others_.has_surface_between(points_beyond(-near), points_beyond(near), index_)) return {};
    for (const double share : k_overshoot_shares) {
      const double by = share * most_;
      bool is_free_so_far = true;
      for (int k = 1; k <= k_probes_across && is_free_so_far; ++k) {
        is_free_so_far = is_free(points_beyond(by * k / k_probes_across));
      }
      if (is_free_so_far) return by;
    }
    return {};
  }

  bool move_end(Extrusion& extrusion, double end) {
    const auto by = overshoot_of(extrusion.profile, [&](const Vector2d& place, double beyond) {
      return Vector3d(place.x(), place.y(), end * (0.5 * extrusion.height + beyond));
    });
    if (!by) return false;
    extrusion.height += *by;
    solid_.pose.position += solid_.pose.orientation * Vector3d(0, 0, 0.5 * end * *by);
    return true;
  }

  bool move_end(Revolution& revolution, double end) {
    const double radius = bounds_of(revolution.profile).max().x();
    const double last = end > 0 ? turn_of(revolution) : 0;
    const auto by = overshoot_of(revolution.profile, [&](const Vector2d& place, double beyond) {
      const double angle = last + end * beyond / radius;
      return Vector3d(place.x() * std::cos(angle), place.x() * std::sin(angle), place.y());
    });
    if (!by) return false;
    const double turn = *by / radius;
    const double angle_deg = revolution.angle_deg + turn / std::numbers::pi * 180;
    if (!(angle_deg < 360)) return false;
    revolution.angle_deg = angle_deg;
    if (end < 0) solid_.pose.orientation = solid_.pose.orientation * Eigen::AngleAxisd(-turn, Vector3d::UnitZ());
    return true;
  }

  PrimitiveIndex index_;
  Primitive solid_;
  const Indifference& others_;
  const AlignedBox& part_;
  Levels levels_;
  double most_;
};

}  // namespace

PrimitiveSet with_overshoots(PrimitiveSet solids, const CsgTree& tree, std::size_t fixed, const AlignedBox& part,
                             const RunContext& run) {
  for (const PrimitiveIndex index : primitives_of(tree)) {
    if (run.stop.stop_requested()) break;
    if (index < fixed || !is_plain(solids[index])) continue;
    const Indifference indifference(solids, tree);
    if (std::optional<Primitive> moved = SolidOvershoot(solids, index, indifference, part).solid()) {
      solids[index].shape = std::move(moved->shape);
      solids[index].pose = moved->pose;
    }
  }
  return solids;
}

}  // namespace cloud2csg
