#include "raw/solids/simplest_solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/primitive/profile.hpp"

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

}  // namespace

Primitive simplest(const Primitive& solid) {
  const auto* extrusion = std::get_if<Extrusion>(&solid.shape);
  const auto* revolution = std::get_if<Revolution>(&solid.shape);
  if (extrusion == nullptr && revolution == nullptr) return solid;
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
