#include "export/openscad_solids.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "cloud2csg/mesh.hpp"
#include "primitive/polytope_faces.hpp"

namespace cloud2csg::openscad {
namespace {

/// Corner numbers counter-clockwise seen from outside.
using FaceCorners = std::vector<std::size_t>;

std::string polyhedron(const std::vector<Eigen::Vector3d>& points, const std::vector<FaceCorners>& faces,
                       const NumberFormat& number) {
  std::vector<std::string> point_texts;
  point_texts.reserve(points.size());
  for (const Eigen::Vector3d& point : points) point_texts.push_back(number(point));
  std::vector<std::string> face_texts;
  face_texts.reserve(faces.size());
  for (const FaceCorners& face : faces) {
    // OpenSCAD turns the other way: clockwise seen from outside.
    face_texts.push_back(fmt::format("[{}]", fmt::join(face.rbegin(), face.rend(), ", ")));
  }
  return fmt::format("polyhedron(\n    points = [{}],\n    faces = [{}]);", fmt::join(point_texts, ", "),
                     fmt::join(face_texts, ", "));
}

std::string polytope_body(const Polytope& polytope, const NumberFormat& number) {
  const PolytopeFaces surface = faces_of(polytope);
  return polyhedron(surface.corners, surface.faces, number);
}

std::string torus_body(const Torus& torus, const NumberFormat& number) {
  const std::string circle =
      fmt::format("translate([{}, 0]) circle(r = {});", number(torus.major_radius), number(torus.minor_radius));
  // Where the profile touches the axis the solid is no 2-manifold, which OpenSCAD refuses: leave a pinhole there.
  constexpr double k_pinhole = 1e-4;
  if (torus.major_radius - torus.minor_radius > k_pinhole * torus.minor_radius) return "rotate_extrude() " + circle;
  return fmt::format("rotate_extrude() intersection() {{\n    {}\n    translate([{}, -{}]) square({});\n  }}", circle,
                     number(k_pinhole * torus.minor_radius), number(torus.minor_radius),
                     number(2.0 * torus.minor_radius));
}

/// A cube whose top face is the half-space's, and large enough to hold all that is below it.
std::string half_space_body(const Pose& pose, const SolidContext& context) {
  const double reach =
      (context.everything.center() - pose.position).norm() + 0.5 * context.everything.diagonal().norm();
  // Two digits are enough for a size that only has to be large.
  const double unit = std::pow(10.0, std::floor(std::log10(reach)) - 1.0);
  const double half = std::ceil(reach / unit) * unit;
  return fmt::format("translate([-{0}, -{0}, -{1}]) cube({1});", context.number(half), context.number(2.0 * half));
}

std::string mesh_body(Primitive primitive, const SolidContext& context) {
  const OrientedBox everything{.pose = {.position = primitive.pose.to_local(context.everything.center()),
                                        .orientation = primitive.pose.orientation.conjugate()},
                               .half_size = 0.5 * context.everything.sizes()};
  primitive.pose = Pose();
  const TriangleMesh mesh = mesh_surface(CsgTree::leaf(0), {primitive}, enclosing_box(everything),
                                         {.resolution = context.mesh_resolution, .corners_first = false});
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) points.push_back(mesh.vertices[i]);
  std::vector<FaceCorners> faces;
  for (const auto& [a, b, c] : mesh.triangles) faces.push_back({a, b, c});
  return polyhedron(points, faces, context.number);
}

class Body {
 public:
  Body(const Primitive& primitive, const SolidContext& context) : primitive_(primitive), context_(context) {}

  std::string operator()(const Box& box) const { return fmt::format("cube({}, center = true);", number(box.size)); }
  std::string operator()(const Sphere& sphere) const { return fmt::format("sphere(r = {});", number(sphere.radius)); }
  std::string operator()(const Cylinder& cylinder) const {
    return fmt::format("cylinder(h = {}, r = {}, center = true);", number(cylinder.height), number(cylinder.radius));
  }
  std::string operator()(const Cone& cone) const {
    return fmt::format("cylinder(h = {}, r1 = {}, r2 = {}, center = true);", number(cone.height),
                       number(cone.radius_bottom), number(cone.radius_top));
  }
  std::string operator()(const Torus& torus) const { return torus_body(torus, context_.number); }
  std::string operator()(const HalfSpace& /*half_space*/) const { return half_space_body(primitive_.pose, context_); }
  std::string operator()(const Polytope& polytope) const { return polytope_body(polytope, context_.number); }
  std::string operator()(const Expression& /*expression*/) const { return mesh_body(primitive_, context_); }

 private:
  template <typename Value>
  [[nodiscard]] std::string number(const Value& value) const {
    return context_.number(value);
  }

  const Primitive& primitive_;
  const SolidContext& context_;
};

}  // namespace

bool needs_mesh(const Primitive& primitive) {
  return !is_plain(primitive);
}

std::string solid(const Primitive& primitive, const SolidContext& context) {
  const std::string body =
      needs_mesh(primitive) ? mesh_body(primitive, context) : std::visit(Body(primitive, context), primitive.shape);
  return placement(primitive, context.number) + body;
}

}  // namespace cloud2csg::openscad
