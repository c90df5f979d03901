#include "io/openscad/solids.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/primitive/shape.hpp"
#include "io/openscad/profile_maps.hpp"

namespace cloud2csg::scad {
namespace {

using Eigen::Affine3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double k_tolerance = 1e-4;

Affine3d linear(const Matrix3d& matrix) {
  Affine3d map = Affine3d::Identity();
  map.linear() = matrix;
  return map;
}

LeafSolid cube(const Arguments& call) {
  const Value* const given = call.find("size", 0);
  const Vector3d size = given == nullptr ? Vector3d::Ones() : vector_or_number(*given, 0);
  call.require(size.minCoeff() > 0, "a cube with three sizes above 0");
  const Vector3d middle = call.flag("center", 1) ? Vector3d(0, 0, 0) : 0.5 * size;
  return {.shape = Box{.size = size}, .frame = Affine3d(Eigen::Translation3d(middle))};
}

using Face = std::vector<Vector3d>;

std::vector<Face> faces_of(const Arguments& call) {
  const Value& points = call.need("points", 0);
  const Value& sides = call.need("faces", 1);
  std::vector<Vector3d> corners;
  corners.reserve(points.items.size());
  for (const Value& point : points.items) corners.push_back(vector_of(point, 0));
  std::vector<Face> faces(sides.items.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (const double corner : numbers_of(sides.items[i])) {
      if (!(corner >= 0 && corner < static_cast<double>(corners.size())))
        throw Refusal(sides.items[i].offset, "expected numbers of points");
      faces[i].push_back(corners[static_cast<std::size_t>(corner)]);
    }
  }
  return faces;
}

/// The plane of a face, with `inside` below it; absent for a sliver, which determines no plane.
std::optional<Plane> plane_of(const Face& face, const Vector3d& inside, double size) {
  Vector3d area = Vector3d::Zero();  // doubled, along the normal (Newell)
  for (std::size_t i = 0; i < face.size(); ++i) {
    area += (face[i] - face[0]).cross(face[(i + 1) % face.size()] - face[0]);
  }
  if (area.norm() <= 1e-9 * size * size) return std::nullopt;
  const Vector3d normal = area.normalized();
  const double offset = normal.dot(face[0]);
  return normal.dot(inside) > offset ? Plane{.normal = -normal, .offset = -offset}
                                     : Plane{.normal = normal, .offset = offset};
}

/// One plane for coplanar faces. validate() refuses the unbounded polytope of an open surface. O(planes x corners)
Polytope convex_polytope(const std::vector<Face>& faces, const Arguments& call) {
  constexpr std::size_t k_most_planes = 64;  // finding a polytope's corners takes time of the fourth power
  Points corners;
  for (const Face& face : faces) {
    for (const Vector3d& corner : face) corners.push_back(corner);
  }
  call.require(corners.size() > 0, "a polyhedron with faces");
  Vector3d middle = Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) middle += corners[i];
  middle /= static_cast<double>(corners.size());
  const double size = bounds_of(corners).diagonal().norm();
  Polytope polytope;
  for (const Face& face : faces) {
    const std::optional<Plane> plane = plane_of(face, middle, size);
    const auto is_same = [&](const Plane& known) {
      return (known.normal - plane->normal).norm() <= k_tolerance &&
             std::abs(known.offset - plane->offset) <= k_tolerance * size;
    };
    if (!plane || std::ranges::any_of(polytope.planes, is_same)) continue;
    polytope.planes.push_back(*plane);
    bool is_convex = polytope.planes.size() <= k_most_planes;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      is_convex = is_convex && plane->normal.dot(corners[i]) - plane->offset <= k_tolerance * size;
    }
    if (is_convex) continue;
    throw Refusal(call.call.offset,
                  fmt::format("expected a convex polyhedron of at most {} flat faces", k_most_planes));
  }
  return polytope;
}

/// A frustum with few corners, placed as OpenSCAD draws them.
std::vector<Face> frustum(double radius_bottom, double radius_top, double height, int facets) {
  const auto corner = [&](int i, bool is_top) {
    const double angle = 2 * std::numbers::pi * (i % facets) / facets;
    return Vector3d((is_top ? radius_top : radius_bottom) * Vector3d(std::cos(angle), std::sin(angle), 0) +
                    (is_top ? 0.5 : -0.5) * height * Vector3d::UnitZ());
  };
  std::vector<Face> faces(2);
  for (int i = 0; i < facets; ++i) {
    faces[0].insert(faces[0].begin(), corner(i, false));
    faces[1].push_back(corner(i, true));
    faces.push_back({corner(i, false), corner(i + 1, false), corner(i + 1, true), corner(i, true)});
  }
  return faces;
}

LeafSolid cylinder(const Arguments& call) {
  const double height = call.number("h", 0, 1);
  const double radius = call.number("r", Arguments::k_by_name, 1);
  const double bottom = call.number("r1", 1, radius);
  const double top = call.number("r2", 2, radius);
  call.require(height > 0 && std::min(bottom, top) >= 0 && std::max(bottom, top) > 0,
               "a cylinder whose height and radii are above 0; one radius may be 0");
  const Eigen::Translation3d shift(0, 0, call.flag("center", 3) ? 0.0 : 0.5 * height);
  LeafSolid solid{.shape = Cone{.radius_bottom = bottom, .radius_top = top, .height = height},
                  .frame = Affine3d(shift)};
  if (bottom == top) solid.shape = Cylinder{.radius = bottom, .height = height};
  if (const std::optional<int> facets = facets_of(call)) {
    solid.shape = convex_polytope(frustum(bottom, top, height, *facets), call);
  }
  return solid;
}

/// Exact at multiples of 90 degrees, as in OpenSCAD.
Matrix3d turn(double degrees, const Vector3d& axis) {
  const double quarters = degrees / 90;
  if (quarters != std::round(quarters)) {
    return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis).toRotationMatrix();
  }
  constexpr std::array<double, 4> k_sines{0, 1, 0, -1};
  const auto quarter = static_cast<std::size_t>(std::fmod(std::fmod(quarters, 4) + 4, 4));
  const double sine = k_sines[quarter];
  const double cosine = k_sines[(quarter + 1) % 4];
  Matrix3d across;
  across << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return cosine * Matrix3d::Identity() + sine * across + (1 - cosine) * axis * axis.transpose();
}

Affine3d rotation(const Arguments& call) {
  const Value& angle = call.need("a", 0);
  if (angle.is_list) {
    const Vector3d angles = vector_of(angle);
    return linear(turn(angles.z(), Vector3d::UnitZ()) * turn(angles.y(), Vector3d::UnitY()) *
                  turn(angles.x(), Vector3d::UnitX()));
  }
  const Value* const given = call.find("v", 1);
  const Vector3d axis = given == nullptr ? Vector3d::UnitZ() : vector_of(*given);
  call.require(!axis.isZero(0), "an axis with a length");
  return linear(turn(number_of(angle), axis.normalized()));
}

Affine3d mirroring(const Arguments& call) {
  const Vector3d normal = vector_of(call.need("v", 0));
  if (normal.isZero(0)) return Affine3d::Identity();
  const Vector3d unit = normal.normalized();
  return linear(Matrix3d::Identity() - 2 * unit * unit.transpose());
}

Affine3d matrix(const Arguments& call) {
  const Value& rows = call.need("m", 0);
  Affine3d map = Affine3d::Identity();
  for (std::size_t row = 0; row < rows.items.size(); ++row) {
    const std::vector<double> numbers = numbers_of(rows.items[row]);
    if (row > 3 || numbers.size() != 4) throw Refusal(rows.offset, "expected a matrix of four rows and columns");
    map.matrix().row(static_cast<Eigen::Index>(row)) = Eigen::RowVector4d::Map(numbers.data());
  }
  call.require(map.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1), "a last row of 0, 0, 0, 1");
  return map;
}

/// Since the text rounds digits, the axes may be slightly off.
Eigen::Quaterniond nearest_rotation(const Matrix3d& axes) {
  const Eigen::JacobiSVD<Matrix3d> parts(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Eigen::Quaterniond(Matrix3d(parts.matrixU() * parts.matrixV().transpose())).normalized();
}

/// A box or polytope under any linear map.
Polytope mapped_planes(const Shape& shape, const Matrix3d& linear) {
  Polytope polytope;
  if (const auto* const box = std::get_if<Box>(&shape)) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d normal = Vector3d::Unit(axis);
      polytope.planes.push_back({.normal = normal, .offset = 0.5 * box->size[axis]});
      polytope.planes.push_back({.normal = -normal, .offset = 0.5 * box->size[axis]});
    }
  } else {
    polytope = std::get<Polytope>(shape);
  }
  const Matrix3d of_normals = linear.inverse().transpose();
  for (Plane& plane : polytope.planes) {
    const Vector3d normal = of_normals * plane.normal;
    plane = {.normal = normal.normalized(), .offset = plane.offset / normal.norm()};
  }
  return polytope;
}

Profile stretched(Profile profile, double along_x, double along_y) {
  return mapped(std::move(profile), Eigen::Vector2d(along_x, along_y).asDiagonal(), Eigen::Vector2d::Zero());
}

/// An extrusion under a map that shears its plane; absent if it is no extrusion of lines, or would lean.
std::optional<Primitive> sheared(const Shape& shape, const Affine3d& frame) {
  const auto* const extrusion = std::get_if<Extrusion>(&shape);
  if (extrusion == nullptr || has_arcs(extrusion->profile)) return std::nullopt;
  const auto plane = frame.linear().leftCols<2>();
  const Vector3d up = frame.linear().col(2).normalized();
  if ((up.transpose() * plane).norm() > k_tolerance * plane.norm()) return std::nullopt;
  Matrix3d axes;
  axes << plane.col(0).normalized(), up.cross(plane.col(0)).normalized(), up;
  const Eigen::Matrix2d in_plane = axes.leftCols<2>().transpose() * plane;
  return Primitive{.id = {},
                   .shape = Extrusion{.profile = mapped(extrusion->profile, in_plane, Eigen::Vector2d::Zero()),
                                      .height = extrusion->height * frame.linear().col(2).norm()},
                   .pose = {.position = frame.translation(), .orientation = nearest_rotation(axes)}};
}

/// A mirror under which the shape is the same: for an extrusion that of z, for a sector the one through its middle, for
/// all others that of x.
Eigen::Matrix3d mirror_of(const Shape& shape) {
  if (std::holds_alternative<Extrusion>(shape)) return Vector3d(1, 1, -1).asDiagonal();
  const auto* revolution = std::get_if<Revolution>(&shape);
  if (revolution == nullptr || is_full_turn(*revolution)) return Vector3d(-1, 1, 1).asDiagonal();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(turn_of(*revolution), Vector3d::UnitZ()).toRotationMatrix();
  return turn * Vector3d(1, -1, 1).asDiagonal();
}

}  // namespace

double round_radius(const Arguments& call) {
  const double radius = call.number("r", 0, 1);
  call.require(radius > 0, "a radius above 0");
  return radius;
}

std::optional<int> facets_of(const Arguments& call) {
  constexpr double k_most = 8;
  const double facets = call.number("$fn", Arguments::k_by_name, 0);
  if (!(facets > 0 && facets < k_most + 1)) return std::nullopt;
  return std::max(static_cast<int>(facets), 3);  // as OpenSCAD does
}

std::optional<Affine3d> map_of(const Arguments& call) {
  const std::string_view name = call.call.raw;
  if (name == "translate") return Affine3d(Eigen::Translation3d(vector_of(call.need("v", 0))));
  if (name == "rotate") return rotation(call);
  if (name == "scale") return linear(vector_or_number(call.need("v", 0), 1).asDiagonal());
  if (name == "mirror") return mirroring(call);
  if (name == "multmatrix") return matrix(call);
  return std::nullopt;
}

std::optional<LeafSolid> leaf_solid(const Arguments& call) {
  const std::string_view name = call.call.raw;
  if (name == "sphere") return LeafSolid{.shape = Sphere{.radius = round_radius(call)}};
  if (name == "cube") return cube(call);
  if (name == "cylinder") return cylinder(call);
  if (name == "polyhedron") return LeafSolid{.shape = convex_polytope(faces_of(call), call)};
  return std::nullopt;
}

Primitive place_solid(const Shape& shape, const Affine3d& frame, std::size_t offset) {
  Matrix3d axes = frame.linear();
  const Vector3d scale = axes.colwise().norm();
  if (!frame.matrix().allFinite() || !(std::abs(axes.determinant()) > 1e-9 * scale.prod())) {
    throw Refusal(offset, "expected a solid with a volume, found one scaled to zero volume");
  }
  axes = axes * scale.cwiseInverse().asDiagonal();
  const Vector3d cosines(axes.col(0).dot(axes.col(1)), axes.col(0).dot(axes.col(2)), axes.col(1).dot(axes.col(2)));
  const bool is_straight = cosines.cwiseAbs().maxCoeff() <= k_tolerance;
  Primitive placed{.id = {}, .shape = shape, .pose = {.position = frame.translation()}};
  if (std::holds_alternative<Polytope>(shape) || (std::holds_alternative<Box>(shape) && !is_straight)) {
    placed.shape = mapped_planes(shape, frame.linear());
    return placed;
  }
  if (!is_straight) {
    if (const std::optional<Primitive> solid = sheared(shape, frame)) return *solid;
  }
  const double across = scale.x();
  const double along = scale.z();
  const auto is_same = [](double a, double b) { return std::abs(a - b) <= k_tolerance * std::max(a, b); };
  const bool is_round = is_straight && is_same(across, scale.y());
  const bool is_even = is_round && is_same(across, along);
  const auto scaled =
      Overloaded{[&](Box& box) { return box.size = box.size.cwiseProduct(scale), true; },
                 [&](Sphere& sphere) { return sphere.radius *= across, is_even; },
                 [&](Cylinder& cylinder) { return cylinder.radius *= across, cylinder.height *= along, is_round; },
                 [&](Cone& cone) {
                   return cone.radius_bottom *= across, cone.radius_top *= across, cone.height *= along, is_round;
                 },
                 [&](Torus& torus) { return torus.major_radius *= across, torus.minor_radius *= across, is_even; },
                 [&](Extrusion& extrusion) {
                   extrusion.height *= along;
                   extrusion.profile = stretched(std::move(extrusion.profile), across, scale.y());
                   return is_straight && (is_round || !has_arcs(extrusion.profile));
                 },
                 [&](Revolution& revolution) {
                   revolution.profile = stretched(std::move(revolution.profile), across, along);
                   return is_round && (is_even || !has_arcs(revolution.profile));
                 },
                 [](auto&) { return false; }};
  if (!std::visit(scaled, placed.shape)) {
    throw Refusal(
        offset,
        fmt::format("expected a scaling that keeps round solids round and upright, found {:.6g}, {:.6g}, {:.6g}",
                    across, scale.y(), along));
  }
  if (axes.determinant() < 0) axes = axes * mirror_of(shape);
  placed.pose.orientation = nearest_rotation(axes);
  return placed;
}

}  // namespace cloud2csg::scad
