#include "io/scripts/openscad_solids.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

#include "io/scripts/script_solids.hpp"

namespace cloud2csg::openscad {
namespace {

/// Writes the solid in its own frame.
class Body {
 public:
  Body(const Primitive& primitive, const SolidContext& context, Parameters& parameters)
      : primitive_(primitive), context_(context), parameters_(parameters) {}

  std::string operator()(const Box& box) const {
    return fmt::format("cube({}, center = true);", parameters_.add("size", list(box.size, context_.number)));
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("sphere(r = {});", value("radius", sphere.radius));
  }
  std::string operator()(const Cylinder& cylinder) const {
    const std::string radius = value("radius", cylinder.radius);
    return fmt::format("cylinder(h = {}, r = {}, center = true);", value("height", cylinder.height), radius);
  }
  std::string operator()(const Cone& cone) const {
    const std::string bottom = value("radius_bottom", cone.radius_bottom);
    const std::string top = value("radius_top", cone.radius_top);
    return fmt::format("cylinder(h = {}, r1 = {}, r2 = {}, center = true);", value("height", cone.height), bottom, top);
  }
  std::string operator()(const Torus& torus) const {
    const std::string major = value("major_radius", torus.major_radius);
    const std::string minor = value("minor_radius", torus.minor_radius);
    const std::string circle = fmt::format("translate([{}, 0]) circle(r = {});", major, minor);
    const std::optional<double> pinhole = pinhole_of(torus, context_.facets);
    if (!pinhole) return "rotate_extrude() " + circle;
    return fmt::format(
        "rotate_extrude() intersection() {{\n    {}\n    translate([{:.3g} * {}, -{}]) square(2 * {});\n  }}", circle,
        *pinhole, minor, minor, minor);
  }
  /// A cube whose top face is the half-space's, and large enough to hold all that is below it.
  std::string operator()(const HalfSpace& /*half_space*/) const {
    const double reach =
        (context_.everything.center() - primitive_.pose.position).norm() + 0.5 * context_.everything.diagonal().norm();
    // Two digits are enough for a size that only has to be large.
    const double unit = std::pow(10.0, std::floor(std::log10(reach)) - 1.0);
    const double half = std::ceil(reach / unit) * unit;
    return fmt::format("translate([-{0}, -{0}, -{1}]) cube({1});", context_.number(half), context_.number(2.0 * half));
  }
  std::string operator()(const Polytope& /*polytope*/) const { return facets(); }
  std::string operator()(const Expression& /*expression*/) const { return facets(); }

  [[nodiscard]] std::string facets() const {
    const brep::KernelSolid solid = script::solid_of(primitive_, context_.everything, context_.mesh_resolution);
    const auto& facets = std::get<brep::Facets>(solid.shape);
    return fmt::format("polyhedron(\n    {});", facet_lists(facets, context_.number, "\n    "));
  }

 private:
  [[nodiscard]] std::string value(const char* what, double number) const {
    return parameters_.add(what, context_.number(number));
  }

  const Primitive& primitive_;
  const SolidContext& context_;
  Parameters& parameters_;
};

}  // namespace

std::optional<double> pinhole_of(const Torus& torus, int facets) {
  constexpr double k_least = 1e-4;
  // OpenSCAD puts corners on a grid of lengths: those around the pinhole must not come to lie on each other.
  constexpr double k_corner_distance = 1.2e-5;
  constexpr double k_most = 0.1;  // in units so small all corners lie on each other
  const double least = k_corner_distance * facets / (2 * std::numbers::pi * torus.minor_radius);
  const double pinhole = std::clamp(least, k_least, k_most);
  const bool has_hole = torus.major_radius - torus.minor_radius > pinhole * torus.minor_radius;
  return has_hole ? std::nullopt : std::optional(pinhole);
}

bool needs_mesh(const Primitive& primitive) {
  return !is_plain(primitive);
}

std::string solid(const Primitive& primitive, const SolidContext& context, Parameters& parameters) {
  const Body body(primitive, context, parameters);
  const std::string shape = needs_mesh(primitive) ? body.facets() : std::visit(body, primitive.shape);
  const Eigen::Vector3d angles = rotation_angles(primitive);
  std::string text =
      fmt::format("translate({}) ", parameters.add("position", list(primitive.pose.position, context.number)));
  if (!angles.isZero(0.0)) {
    text += fmt::format("rotate({}) ", parameters.add("rotation", list(angles, script::NumberFormat(1.0))));
  }
  return text + shape;
}

std::string facet_lists(const brep::Facets& facets, const script::NumberFormat& number, const std::string& separator) {
  std::vector<std::string> points;
  points.reserve(facets.corners.size());
  for (const Eigen::Vector3d& corner : facets.corners) points.push_back(list(corner, number));
  std::vector<std::string> faces;
  faces.reserve(facets.faces.size());
  for (const auto& face : facets.faces) {
    // OpenSCAD turns the other way: clockwise seen from outside.
    faces.push_back(fmt::format("[{}]", fmt::join(face.rbegin(), face.rend(), ", ")));
  }
  return fmt::format("points = [{}],{}faces = [{}]", fmt::join(points, ", "), separator, fmt::join(faces, ", "));
}

}  // namespace cloud2csg::openscad
