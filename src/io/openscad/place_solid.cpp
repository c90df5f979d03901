#include "io/openscad/place_solid.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>

namespace cloud2csg::scad {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double k_tolerance = 1e-4;
// What a polytope's corners cost grows with the fourth power of its planes.
constexpr std::size_t k_most_planes = 64;

/// An affine map as a scaling along three axes, then a motion.
struct Stretch {
  Pose pose;
  Vector3d scale;
  bool is_straight;  ///< the axes stay at right angles
};

Stretch stretch_of(const Eigen::Affine3d& frame) {
  Matrix3d axes = frame.linear();
  const Vector3d scale = axes.colwise().norm();
  axes = axes * scale.cwiseInverse().asDiagonal();
  const Vector3d cosines(axes.col(0).dot(axes.col(1)), axes.col(0).dot(axes.col(2)), axes.col(1).dot(axes.col(2)));
  // All solids that this is for are their own mirror images along x.
  if (axes.determinant() < 0) axes.col(0) *= -1;
  // The rotation that is nearest: digits are missing.
  const Eigen::JacobiSVD<Matrix3d> parts(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Stretch stretch{.pose = {.position = frame.translation()},
                  .scale = scale,
                  .is_straight = cosines.cwiseAbs().maxCoeff() <= k_tolerance};
  stretch.pose.orientation = Eigen::Quaterniond(Matrix3d(parts.matrixU() * parts.matrixV().transpose())).normalized();
  return stretch;
}

bool equal(double a, double b) {
  return std::abs(a - b) <= k_tolerance * std::max(a, b);
}

Polytope moved(const Polytope& polytope, const Matrix3d& linear) {
  const Matrix3d of_normals = linear.inverse().transpose();
  Polytope result;
  result.planes.reserve(polytope.planes.size());
  for (const Plane& plane : polytope.planes) {
    const Vector3d normal = of_normals * plane.normal;
    result.planes.push_back({.normal = normal.normalized(), .offset = plane.offset / normal.norm()});
  }
  return result;
}

Polytope as_polytope(const Box& box) {
  Polytope polytope;
  polytope.planes.reserve(6);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d normal = Vector3d::Unit(axis);
    polytope.planes.push_back({.normal = normal, .offset = 0.5 * box.size[axis]});
    polytope.planes.push_back({.normal = -normal, .offset = 0.5 * box.size[axis]});
  }
  return polytope;
}

using Placed = std::variant<Primitive, Misfit>;

class Placement {
 public:
  explicit Placement(const Eigen::Affine3d& frame) : frame_(frame), stretch_(stretch_of(frame)) {}

  Placed operator()(const Box& box) const {
    if (stretch_.is_straight) return straight(Box{.size = box.size.cwiseProduct(stretch_.scale)});
    return (*this)(as_polytope(box));
  }
  Placed operator()(const Polytope& polytope) const {
    return Primitive{.id = {}, .shape = moved(polytope, frame_.linear()), .pose = {.position = frame_.translation()}};
  }
  Placed operator()(const Sphere& sphere) const {
    if (!is_even()) return misfit("sphere stays a sphere");
    return straight(Sphere{.radius = sphere.radius * stretch_.scale.x()});
  }
  Placed operator()(const Cylinder& cylinder) const {
    if (!is_round()) return misfit("cylinder stays round and upright");
    return straight(Cylinder{.radius = cylinder.radius * stretch_.scale.x(),  //
                             .height = cylinder.height * stretch_.scale.z()});
  }
  Placed operator()(const Cone& cone) const {
    if (!is_round()) return misfit("cone stays round and upright");
    return straight(Cone{.radius_bottom = cone.radius_bottom * stretch_.scale.x(),
                         .radius_top = cone.radius_top * stretch_.scale.x(),
                         .height = cone.height * stretch_.scale.z()});
  }
  Placed operator()(const Torus& torus) const {
    if (!is_even()) return misfit("torus keeps its proportions");
    return straight(Torus{.major_radius = torus.major_radius * stretch_.scale.x(),
                          .minor_radius = torus.minor_radius * stretch_.scale.x()});
  }
  Placed operator()(const HalfSpace& /*half_space*/) const { return misfit("solid has bounds"); }
  Placed operator()(const Expression& /*expression*/) const { return misfit("solid is no formula"); }

 private:
  [[nodiscard]] bool is_round() const { return stretch_.is_straight && equal(stretch_.scale.x(), stretch_.scale.y()); }
  [[nodiscard]] bool is_even() const { return is_round() && equal(stretch_.scale.x(), stretch_.scale.z()); }
  [[nodiscard]] Placed straight(Shape shape) const {
    return Primitive{.id = {}, .shape = std::move(shape), .pose = stretch_.pose};
  }
  [[nodiscard]] Placed misfit(const char* what) const {
    return Misfit{fmt::format("expected a scaling after which the {}, found one by {:.6g}, {:.6g}, {:.6g}{}", what,
                              stretch_.scale.x(), stretch_.scale.y(), stretch_.scale.z(),
                              stretch_.is_straight ? "" : " with a shear")};
  }

  const Eigen::Affine3d& frame_;
  Stretch stretch_;
};

/// Twice the face's area along its normal (Newell); zero for a face that has none.
Vector3d area_of(std::span<const Vector3d> corners, const std::vector<std::size_t>& face) {
  Vector3d area = Vector3d::Zero();
  for (std::size_t i = 0; i < face.size(); ++i) {
    area += (corners[face[i]] - corners[face[0]]).cross(corners[face[(i + 1) % face.size()]] - corners[face[0]]);
  }
  return area;
}

/// Whether each edge has a face on either side.
bool is_closed(std::span<const std::vector<std::size_t>> faces) {
  std::map<std::pair<std::size_t, std::size_t>, int> balance;  // of the directions in which an edge is passed
  for (const std::vector<std::size_t>& face : faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      const std::size_t a = face[i];
      const std::size_t b = face[(i + 1) % face.size()];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

bool has_plane(const Polytope& polytope, const Plane& plane, double size) {
  return std::ranges::any_of(polytope.planes, [&](const Plane& known) {
    return (known.normal - plane.normal).norm() <= k_tolerance &&
           std::abs(known.offset - plane.offset) <= k_tolerance * size;
  });
}

}  // namespace

Placed place_solid(const Shape& shape, const Eigen::Affine3d& frame) {
  const Vector3d lengths = frame.linear().colwise().norm();
  const double volume = std::abs(frame.linear().determinant());
  if (!frame.matrix().allFinite() || !(volume > 1e-9 * lengths.prod())) {
    return Misfit{"expected a solid with a volume, found one that is scaled to none"};
  }
  return std::visit(Placement(frame), shape);
}

std::variant<Polytope, Misfit> convex_polytope(std::span<const Vector3d> corners,
                                               std::span<const std::vector<std::size_t>> faces) {
  AlignedBox box;
  Vector3d middle = Vector3d::Zero();
  std::size_t count = 0;
  for (const std::vector<std::size_t>& face : faces) {
    for (const std::size_t corner : face) {
      box.extend(corners[corner]);
      middle += corners[corner];
      ++count;
    }
  }
  if (count < 4 || !is_closed(faces)) return Misfit{"expected a closed polyhedron, found an edge with one face"};
  middle /= static_cast<double>(count);
  const double size = box.diagonal().norm();
  Polytope polytope;
  for (const std::vector<std::size_t>& face : faces) {
    const Vector3d area = area_of(corners, face);
    if (area.norm() <= 1e-9 * size * size) continue;  // a sliver, which says nothing of a plane
    Plane plane{.normal = area.normalized(), .offset = 0};
    plane.offset = plane.normal.dot(corners[face[0]]);
    if (plane.normal.dot(middle) > plane.offset) plane = {.normal = -plane.normal, .offset = -plane.offset};
    for (const std::vector<std::size_t>& other : faces) {
      for (const std::size_t corner : other) {
        if (plane.normal.dot(corners[corner]) - plane.offset > k_tolerance * size) {
          return Misfit{"expected a convex polyhedron, found a corner outside of one of its faces"};
        }
      }
    }
    if (!has_plane(polytope, plane, size)) polytope.planes.push_back(plane);
    if (polytope.planes.size() > k_most_planes) {
      return Misfit{fmt::format("expected a polyhedron of at most {} flat faces, found more", k_most_planes)};
    }
  }
  return polytope;
}

std::variant<Polytope, Misfit> faceted_frustum(double radius_bottom, double radius_top, double height, int facets) {
  std::vector<Vector3d> corners;
  corners.reserve(2 * static_cast<std::size_t>(facets));
  std::vector<std::vector<std::size_t>> faces(2);
  for (int i = 0; i < facets; ++i) {
    const double angle = 2 * std::numbers::pi * i / facets;
    const Vector3d outward(std::cos(angle), std::sin(angle), 0);
    corners.emplace_back(radius_bottom * outward - 0.5 * height * Vector3d::UnitZ());
    corners.emplace_back(radius_top * outward + 0.5 * height * Vector3d::UnitZ());
    const std::size_t bottom = 2 * static_cast<std::size_t>(i);
    const std::size_t next = (bottom + 2) % (2 * static_cast<std::size_t>(facets));
    faces.push_back({bottom, next, next + 1, bottom + 1});
    faces[0].insert(faces[0].begin(), bottom);
    faces[1].push_back(bottom + 1);
  }
  return convex_polytope(corners, faces);
}

}  // namespace cloud2csg::scad
