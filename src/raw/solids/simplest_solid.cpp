#include "raw/solids/simplest_solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/primitive/profile.hpp"
#include "core/primitive/shape.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double k_equal = 1e-6;  // of a profile's size

/// Permutes and flips the axes for the least rotation from the coordinate axes.
Eigen::Matrix3d turned_least(const Eigen::Matrix3d& axes) {
  Eigen::Matrix3d best = axes;
  std::array<Eigen::Index, 3> order{0, 1, 2};
  do {
    for (const double x : {1.0, -1.0}) {
      for (const double y : {1.0, -1.0}) {
        Eigen::Matrix3d turned;
        turned.col(0) = x * axes.col(order[0]);
        turned.col(1) = y * axes.col(order[1]);
        turned.col(2) = turned.col(0).cross(turned.col(1));
        if (turned.trace() > best.trace() + 1e-9) best = turned;
      }
    }
  } while (std::ranges::next_permutation(order).found);
  return best;
}

Primitive with_shape(const Primitive& solid, Shape shape, const Vector3d& local_middle) {
  Primitive result{.id = solid.id, .shape = std::move(shape), .pose = solid.pose};
  result.pose.position += solid.pose.orientation * local_middle;
  return result;
}

/// A path of lines with right angles as a box.
std::optional<Primitive> as_box(const Primitive& solid, const std::vector<ProfileSegment>& sides, double height) {
  if (sides.size() != 4) return std::nullopt;
  if (std::ranges::any_of(sides, [](const ProfileSegment& side) { return side.is_arc(); })) return std::nullopt;
  const Vector2d u = sides[0].end - sides[0].start;
  const Vector2d v = sides[1].end - sides[1].start;
  const Vector2d diagonal = u + v;
  const bool is_skew = std::abs(u.dot(v)) > k_equal * u.norm() * v.norm() ||
                       (sides[3].start - sides[0].start - v).norm() > k_equal * diagonal.norm();
  if (is_skew) return std::nullopt;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  axes.col(0).head<2>() = u.normalized();
  axes.col(1).head<2>() = v.normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  axes = solid.pose.orientation.toRotationMatrix() * axes;
  const Eigen::Matrix3d turned = turned_least(axes);
  const Vector3d size = (turned.transpose() * axes).cwiseAbs() * Vector3d(u.norm(), v.norm(), height);
  const Vector2d middle = sides[0].start + 0.5 * diagonal;
  Primitive box = with_shape(solid, Box{size}, Vector3d(middle.x(), middle.y(), 0));
  box.pose.orientation = Eigen::Quaterniond(turned).normalized();
  return box;
}

/// A path that begins and ends on the axis, with at most three lines between, as a cylinder or cone.
std::optional<Primitive> as_cone(const Primitive& solid, const std::vector<ProfileSegment>& sides, double rounding) {
  if (sides.size() != 3 && sides.size() != 4) return std::nullopt;
  double low = 0;
  double high = 0;
  for (const ProfileSegment& side : sides) {
    if (side.is_arc()) return std::nullopt;
    if (!side.is_on_axis()) continue;
    low = std::min(side.start.y(), side.end.y());
    high = std::max(side.start.y(), side.end.y());
  }
  double bottom = 0;
  double top = 0;
  for (const ProfileSegment& side : sides) {
    const Vector2d corner = side.start;
    if (corner.x() == 0) continue;
    double& radius = corner.y() - low < high - corner.y() ? bottom : top;
    const double level = &radius == &bottom ? low : high;
    if (std::abs(corner.y() - level) > rounding || radius != 0) return std::nullopt;
    radius = corner.x();
  }
  if (!(high > low) || (bottom == 0 && top == 0)) return std::nullopt;
  const Vector3d middle(0, 0, 0.5 * (low + high));
  if (std::abs(bottom - top) <= rounding) {
    return with_shape(solid, Cylinder{.radius = 0.5 * (bottom + top), .height = high - low}, middle);
  }
  return with_shape(solid, Cone{.radius_bottom = bottom, .radius_top = top, .height = high - low}, middle);
}

/// Half a disc on the axis as a sphere.
std::optional<Primitive> as_sphere(const Primitive& solid, const std::vector<ProfileSegment>& sides, double rounding) {
  if (sides.size() != 2) return std::nullopt;
  const ProfileSegment& arc = sides[0].is_arc() ? sides[0] : sides[1];
  const ProfileSegment& line = sides[0].is_arc() ? sides[1] : sides[0];
  if (!arc.is_arc() || !line.is_on_axis() || std::abs(arc.centre.x()) > rounding) return std::nullopt;
  return with_shape(solid, Sphere{arc.radius}, Vector3d(0, 0, arc.centre.y()));
}

/// Whether all planes are along the direction, apart from two ends.
bool is_prism_along(const Vector3d& direction, const Polytope& polytope) {
  const auto ends = std::ranges::count_if(
      polytope.planes, [&](const Plane& plane) { return (plane.normal.cross(direction)).norm() <= k_equal; });
  return ends == 2 && std::ranges::all_of(polytope.planes, [&](const Plane& plane) {
           const double sine = std::abs(plane.normal.dot(direction));
           return sine <= k_equal || sine >= 1 - k_equal;
         });
}

/// A polytope with two ends across all other planes as an extrusion.
std::optional<Primitive> as_prism(const Primitive& solid, const Polytope& polytope) {
  const auto end =
      std::ranges::find_if(polytope.planes, [&](const Plane& plane) { return is_prism_along(plane.normal, polytope); });
  if (end == polytope.planes.end()) return std::nullopt;
  const Pose frame = pose_from_axis(Vector3d::Zero(), end->normal);
  AlignedBox box;
  std::vector<Vector3d> places_in_space;
  for (const Vector3d& corner : corners(polytope)) {
    places_in_space.push_back(frame.to_local(corner));
    box.extend(places_in_space.back());
  }
  const double height = box.isEmpty() ? 0.0 : box.sizes().z();
  const double rounding = k_equal * (box.isEmpty() ? 0.0 : box.diagonal().norm());
  std::vector<Vector2d> places;
  for (const Vector3d& corner : places_in_space) {
    const Vector2d place = corner.head<2>();
    const auto is_near = [&](const Vector2d& known) { return (known - place).norm() <= rounding; };
    if (std::ranges::none_of(places, is_near)) places.push_back(place);
  }
  if (!(height > rounding) || places.size() < 3) return std::nullopt;
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& place : places) middle += place / static_cast<double>(places.size());
  std::ranges::sort(places, {}, [&](const Vector2d& p) { return std::atan2(p.y() - middle.y(), p.x() - middle.x()); });
  ClosedPath path;
  for (const Vector2d& place : places) path.push_back({.point = place - middle});
  Primitive prism = with_shape(solid, Extrusion{.profile = {.paths = {path}}, .height = height},
                               frame.to_world({middle.x(), middle.y(), end->offset - 0.5 * height}));
  prism.pose.orientation = solid.pose.orientation * frame.orientation;
  return prism;
}

}  // namespace

Primitive simplest(const Primitive& solid) {
  if (const auto* polytope = std::get_if<Polytope>(&solid.shape)) {
    const std::optional<Primitive> prism = as_prism(solid, *polytope);
    return prism ? simplest(*prism) : solid;
  }
  const auto* extrusion = std::get_if<Extrusion>(&solid.shape);
  const auto* revolution = std::get_if<Revolution>(&solid.shape);
  if (extrusion == nullptr && (revolution == nullptr || !is_full_turn(*revolution))) return solid;
  const Profile& profile = extrusion != nullptr ? extrusion->profile : revolution->profile;
  if (profile.paths.size() != 1) return solid;
  const std::vector<ProfileSegment> sides = segments_of(profile.paths[0]);
  const ProfileSegment& first = sides[0];
  if (extrusion != nullptr) {
    if (!is_circle(sides)) return as_box(solid, sides, extrusion->height).value_or(solid);
    return with_shape(solid, Cylinder{.radius = first.radius, .height = extrusion->height},
                      Vector3d(first.centre.x(), first.centre.y(), 0));
  }
  if (is_circle(sides)) {
    return with_shape(solid, Torus{.major_radius = first.centre.x(), .minor_radius = first.radius},
                      Vector3d(0, 0, first.centre.y()));
  }
  const double rounding = k_equal * bounds_of(profile).diagonal().norm();
  if (const auto sphere = as_sphere(solid, sides, rounding)) return *sphere;
  return as_cone(solid, sides, rounding).value_or(solid);
}

}  // namespace cloud2csg
