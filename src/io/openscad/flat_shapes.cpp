#include "io/openscad/flat_shapes.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/primitive/profile.hpp"
#include "io/openscad/profile_maps.hpp"

namespace cloud2csg::scad {
namespace {

using Eigen::Affine3d;
using Eigen::AlignedBox2d;
using Eigen::Matrix2d;
using Eigen::Vector2d;

Profile circle(const Arguments& call, bool is_turned) {
  const Value* const diameter = call.find("d", Arguments::k_by_name);
  const double radius = diameter == nullptr ? round_radius(call) : 0.5 * number_of(*diameter);
  call.require(radius > 0, "a diameter above 0");
  const std::optional<int> facets = is_turned ? std::nullopt : facets_of(call);
  if (!facets) return {.paths = {{{.point = {radius, 0}, .bulge = 1}, {.point = {-radius, 0}, .bulge = 1}}}};
  ClosedPath path;
  for (int i = 0; i < *facets; ++i) {
    const double angle = 2 * std::numbers::pi * i / *facets;
    path.push_back({.point = radius * Vector2d(std::cos(angle), std::sin(angle))});
  }
  return {.paths = {path}};
}

Profile square(const Arguments& call) {
  const Value* const given = call.find("size", 0);
  call.require(given == nullptr || given->items.size() <= 2, "a square with two sizes");
  const Vector2d size = given == nullptr ? Vector2d::Ones() : Vector2d(vector_or_number(*given, 0).head<2>());
  call.require(size.minCoeff() > 0, "a square with two sizes above 0");
  const Vector2d low = call.flag("center", 1) ? Vector2d(-0.5 * size) : Vector2d::Zero();
  const Vector2d high = low + size;
  return {.paths = {{{.point = low}, {.point = {high.x(), low.y()}}, {.point = high}, {.point = {low.x(), high.y()}}}}};
}

PathCorner corner_of(const Value& value, bool has_bulge) {
  const std::vector<double> numbers = numbers_of(value);
  if (numbers.size() == 2) return {.point = {numbers[0], numbers[1]}};
  if (!has_bulge) throw Refusal(value.offset, "expected a point of two numbers");
  if (numbers.size() != 3) throw Refusal(value.offset, "expected a corner of two or three numbers");
  return {.point = {numbers[0], numbers[1]}, .bulge = numbers[2]};
}

/// Without corners that repeat the one before: many programs close paths with their first corner.
ClosedPath without_repetition(ClosedPath path) {
  ClosedPath kept;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i].point != path[(i + 1) % path.size()].point) kept.push_back(path[i]);
  }
  return kept;
}

ClosedPath chosen_corners(const ClosedPath& corners, const Value& numbers) {
  ClosedPath path;
  for (const double number : numbers_of(numbers)) {
    if (!(number >= 0 && number < static_cast<double>(corners.size()))) {
      throw Refusal(numbers.offset, "expected numbers of points");
    }
    path.push_back(corners[static_cast<std::size_t>(number)]);
  }
  return path;
}

Profile polygon(const Arguments& call) {
  constexpr std::size_t k_most_corners = 10'000;  // finding crossings takes time of the second power
  const Value& points = call.need("points", 0);
  const Value* paths = call.find("paths", 1);
  if (paths != nullptr && paths->is_list && paths->items.empty()) paths = nullptr;
  if (!points.is_list) throw Refusal(points.offset, "expected a list of points");
  ClosedPath corners;
  for (const Value& point : points.items) corners.push_back(corner_of(point, points.is_path));
  Profile profile;
  if (paths == nullptr) {
    profile.paths.push_back(std::move(corners));
  } else {
    if (!paths->is_list || points.is_path) throw Refusal(paths->offset, "expected a list of paths over plain points");
    const bool is_single = !paths->items.empty() && !paths->items.front().is_list;
    if (is_single) profile.paths.push_back(chosen_corners(corners, *paths));
    for (std::size_t i = 0; i < paths->items.size() && !is_single; ++i) {
      if (paths->items[i].is_list && paths->items[i].items.empty()) continue;
      profile.paths.push_back(chosen_corners(corners, paths->items[i]));
    }
  }
  std::size_t count = 0;
  for (ClosedPath& path : profile.paths) {
    path = without_repetition(std::move(path));
    count += path.size();
    call.require(path.size() >= (has_arcs({.paths = {path}}) ? 2U : 3U),
                 "a polygon of three different corners or more");
  }
  call.require(count > 0 && count <= k_most_corners, fmt::format("a polygon of at most {} corners", k_most_corners));
  return profile;
}

/// The height of an extrusion that neither tapers nor twists.
double height_of(const Arguments& call) {
  if (const Value* const scale = call.find("scale", Arguments::k_by_name); scale != nullptr) {
    if (vector_or_number(*scale, 1) != Eigen::Vector3d::Ones()) {
      throw Refusal(scale->offset, "expected an extrusion with a scale of 1");
    }
  }
  if (const Value* const twist = call.find("twist", Arguments::k_by_name); twist != nullptr && number_of(*twist) != 0) {
    throw Refusal(twist->offset, "expected an extrusion without a twist");
  }
  if (const Value* const direction = call.find("v", Arguments::k_by_name); direction != nullptr) {
    throw Refusal(direction->offset, "expected an extrusion by its height alone");
  }
  constexpr double k_height = 100;  // OpenSCAD's, too
  const Value* const given = call.find("height", 0);
  const bool is_first = !call.values.empty() && given == &call.values.front().second;
  if (given != nullptr && call.find("height", Arguments::k_by_name) == nullptr && !is_first) {
    throw Refusal(given->offset, "expected a height as the first argument or by its name");
  }
  const double height = given == nullptr ? k_height : number_of(*given);
  call.require(height > 0, "a height above 0");
  return height;
}

/// From `start` by `angle`, backwards for a negative one. A full turn has no start.
Sweep turn_of(const Arguments& call) {
  const Value* const given = call.find("angle", 0);
  if (given != nullptr && call.find("angle", Arguments::k_by_name) == nullptr) {
    throw Refusal(given->offset, "expected an angle by its name");
  }
  const double angle = std::clamp(call.number("angle", Arguments::k_by_name, 360), -360.0, 360.0);
  call.require(angle != 0, "an angle other than 0");
  Sweep sweep{.height = std::nullopt, .angle_deg = std::abs(angle)};
  if (sweep.angle_deg == 360) return sweep;
  const double start = call.number("start", Arguments::k_by_name, 0) + std::min(angle, 0.0);
  sweep.frame = Eigen::AngleAxisd(start / 180 * std::numbers::pi, Eigen::Vector3d::UnitZ());
  return sweep;
}

/// Whether the shape cuts only a pinhole next to the axis from a circle, as a square does that our files write. Without
/// it, the torus may be no valid solid.
bool leaves_pinhole(const Profile& shape, const ProfileSegment& circle_arc) {
  constexpr double k_widest = 0.1;  // in circle radii, roughly; the missing volume grows with its power 5/2
  constexpr double k_rounding = 1e-6;
  const AlignedBox2d box = bounds_of(shape);
  const bool is_rectangle = shape.paths.size() == 1 && shape.paths[0].size() == 4 && !has_arcs(shape) &&
                            std::abs(area_of(shape) - box.volume()) <= k_rounding * box.volume();
  const Vector2d from = (box.min() - circle_arc.centre) / circle_arc.radius;
  const Vector2d to = (box.max() - circle_arc.centre) / circle_arc.radius;
  return is_rectangle && from.x() <= k_widest - 1 + k_rounding && from.y() <= k_rounding - 1 &&
         to.minCoeff() >= 1 - k_rounding;
}

}  // namespace

Sweep sweep_of(const Arguments& call) {
  if (call.call.raw == "linear_extrude") {
    const double height = height_of(call);
    const double middle = call.flag("center", Arguments::k_by_name) ? 0.0 : 0.5 * height;
    return {.height = height, .frame = Affine3d(Eigen::Translation3d(0, 0, middle))};
  }
  return turn_of(call);
}

std::optional<Profile> flat_profile(const Arguments& call, bool is_turned) {
  if (call.call.raw == "circle") return circle(call, is_turned);
  if (call.call.raw == "square") return square(call);
  if (call.call.raw == "polygon") return polygon(call);
  return std::nullopt;
}

FlatShape placed_in_plane(const FlatShape& shape, const Affine3d& frame) {
  constexpr double k_tilt = 1e-9;
  constexpr double k_uneven = 1e-4;  // OpenSCAD writes six digits
  const Matrix2d linear = frame.linear().topLeftCorner<2, 2>();
  const Vector2d scale = linear.colwise().norm();
  const double tilt = std::max(frame.linear().block<2, 1>(0, 2).norm(), frame.linear().block<1, 2>(2, 0).norm());
  if (!frame.matrix().allFinite() || !(tilt <= k_tilt * scale.maxCoeff())) {
    throw Refusal(shape.offset, "expected a flat shape that stays in its plane");
  }
  if (!(std::abs(linear.determinant()) > 1e-9 * scale.prod())) {
    throw Refusal(shape.offset, "expected a flat shape with an area, found one scaled to zero area");
  }
  const bool is_even = std::abs(scale.x() - scale.y()) <= k_uneven * scale.maxCoeff() &&
                       std::abs(linear.col(0).dot(linear.col(1))) <= k_uneven * scale.prod();
  if (!is_even && has_arcs(shape.profile)) {
    throw Refusal(shape.offset, "expected a scaling that keeps circles round");
  }
  return {.profile = mapped(shape.profile, linear, frame.translation().head<2>()), .offset = shape.offset};
}

std::optional<LeafSolid> torus_of(const FlatTree& tree) {
  const bool is_cut = tree.nodes.size() == 3 && tree.nodes.back() == CsgNode::inner(Operation::intersection, 3);
  if (tree.nodes.size() != 1 && !is_cut) return std::nullopt;
  // Shapes that no node uses are left of operations that came to nothing.
  const Profile& profile = tree.shapes[tree.nodes[0].primitive()].profile;
  const std::vector<ProfileSegment> path = segments_of(profile.paths[0]);
  if (profile.paths.size() != 1 || !is_circle(path)) return std::nullopt;
  if (is_cut && !leaves_pinhole(tree.shapes[tree.nodes[1].primitive()].profile, path[0])) return std::nullopt;
  const Vector2d centre = path[0].centre;
  constexpr double k_rounding = 1e-12;
  if (centre.x() < path[0].radius * (1 - k_rounding)) return std::nullopt;
  return LeafSolid{.shape = Torus{.major_radius = centre.x(), .minor_radius = std::min(path[0].radius, centre.x())},
                   .frame = Affine3d(Eigen::Translation3d(0, 0, centre.y()))};
}

Shape swept(FlatShape shape, const Sweep& sweep) {
  if (sweep.height) return Extrusion{.profile = std::move(shape.profile), .height = *sweep.height};
  constexpr double k_rounding = 1e-9;
  const AlignedBox2d box = bounds_of(shape.profile);
  const double tolerance = k_rounding * box.diagonal().norm();
  if (box.min().x() < -tolerance) {
    throw Refusal(shape.offset, "expected a shape entirely to the right of the axis (x >= 0)");
  }
  for (ClosedPath& path : shape.profile.paths) {
    for (PathCorner& corner : path) {
      if (std::abs(corner.point.x()) <= tolerance) corner.point.x() = 0;
    }
  }
  return Revolution{.profile = std::move(shape.profile), .angle_deg = sweep.angle_deg};
}

}  // namespace cloud2csg::scad
