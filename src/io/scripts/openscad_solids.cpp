#include "io/scripts/openscad_solids.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <sstream>
#include <variant>
#include <vector>

#include "core/primitive/profile.hpp"
#include "core/primitive/shape.hpp"
#include "io/scripts/script_solids.hpp"

namespace cloud2csg::openscad {
namespace {

using script::degrees_of;

/// Angles for rotate([x, y, z]): about the fixed axes, x first and z last.
Eigen::Vector3d euler_angles(const Eigen::Matrix3d& m) {
  const double y = std::atan2(-m(2, 0), std::hypot(m(0, 0), m(1, 0)));
  constexpr double k_pole = 1e-9;
  if (std::hypot(m(0, 0), m(1, 0)) < k_pole) {
    // Gimbal lock: rotations about x and z coincide.
    return {degrees_of(std::atan2(-m(1, 2), m(1, 1))), degrees_of(y), 0.0};
  }
  return {degrees_of(std::atan2(m(2, 1), m(2, 2))), degrees_of(y), degrees_of(std::atan2(m(1, 0), m(0, 0)))};
}

/// Angles that turn the z axis into `axis`: about x alone if possible, else about y, then z.
Eigen::Vector3d axis_angles(const Eigen::Vector3d& axis) {
  constexpr double k_flat = 1e-12;
  if (std::abs(axis.x()) < k_flat) return {degrees_of(std::atan2(-axis.y(), axis.z())), 0.0, 0.0};
  const double off_axis = std::hypot(axis.x(), axis.y());
  return {0.0, degrees_of(std::atan2(off_axis, axis.z())), degrees_of(std::atan2(axis.y(), axis.x()))};
}

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
  /// A cube with the half-space's face on top, large enough to hold everything below it.
  std::string operator()(const HalfSpace& /*half_space*/) const {
    const double reach =
        (context_.everything.center() - primitive_.pose.position).norm() + 0.5 * context_.everything.diagonal().norm();
    // Two digits suffice for a size that only has to be large.
    const double unit = std::pow(10.0, std::floor(std::log10(reach)) - 1.0);
    const double half = std::ceil(reach / unit) * unit;
    return fmt::format("translate([-{0}, -{0}, -{1}]) cube({1});", context_.number(half), context_.number(2.0 * half));
  }
  std::string operator()(const Extrusion& extrusion) const {
    const std::string profile = profile_text(extrusion.profile);
    return fmt::format("linear_extrude(height = {}, center = true, convexity = 10) {}",
                       value("height", extrusion.height), profile);
  }
  std::string operator()(const Revolution& revolution) const {
    const std::string profile = profile_text(revolution.profile);
    if (is_full_turn(revolution)) return "rotate_extrude(convexity = 10) " + profile;
    const std::string angle = parameters_.add("angle", script::NumberFormat(1.0)(revolution.angle_deg));
    return fmt::format("rotate_extrude(angle = {}, convexity = 10) {}", angle, profile);
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

  /// A block that stands `indent` spaces in, without those of its first line.
  [[nodiscard]] static std::string block(const std::string& head, const std::vector<std::string>& parts, int indent) {
    const std::string margin = fmt::format("\n{:{}}", "", indent);
    return fmt::format("{}{{{}  {}{}}}", head, margin, fmt::join(parts, margin + "  "), margin);
  }

  /// `polygon(...);`, or `difference() { ... }` with holes, or a block of these.
  [[nodiscard]] std::string profile_text(const Profile& profile) const {
    const std::vector<ProfileRegion> regions = regions_of(profile);
    const bool is_single = regions.size() == 1;
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const auto& [outline, holes] = regions[i];
      const std::string part = is_single ? "" : fmt::format("part_{}_", i + 1);
      std::vector<std::string> paths{path_text(part + "outline", outline)};
      for (std::size_t k = 0; k < holes.size(); ++k) {
        paths.push_back(path_text(fmt::format("{}hole_{}", part, k + 1), holes[k]));
      }
      parts.push_back(holes.empty() ? paths.front() : block("difference() ", paths, is_single ? 2 : 4));
    }
    return is_single ? parts.front() : block("", parts, 2);
  }

  [[nodiscard]] std::string path_text(const std::string& what, const std::vector<ProfileSegment>& path) const {
    if (is_circle(path)) {
      const Eigen::Vector2d centre = path.front().centre;
      std::string circle = fmt::format("circle(r = {});", value((what + "_radius").c_str(), path.front().radius));
      if (centre.isZero(0)) return circle;
      const std::string place = fmt::format("[{}, {}]", context_.number(centre.x()), context_.number(centre.y()));
      return fmt::format("translate({}) {}", parameters_.add(what + "_centre", place), circle);
    }
    std::vector<std::string> corners;
    for (const ProfileSegment& s : path) {
      const std::string bulge = s.is_arc() ? ", " + script::NumberFormat(1.0)(s.bulge) : "";
      corners.push_back(fmt::format("[{}, {}{}]", context_.number(s.start.x()), context_.number(s.start.y()), bulge));
    }
    const std::string name = parameters_.add(what, fmt::format("[{}]", fmt::join(corners, ", ")));
    const bool has_arcs = std::ranges::any_of(path, [](const ProfileSegment& s) { return s.is_arc(); });
    return has_arcs ? fmt::format("polygon(path({}));", name) : fmt::format("polygon({});", name);
  }

  const Primitive& primitive_;
  const SolidContext& context_;
  Parameters& parameters_;
};

}  // namespace

const std::set<std::string>& reserved_words() {
  static const std::set<std::string> words = [] {
    std::istringstream all(
        "assert assign child children circle color cube cylinder difference dxf_linear_extrude "
        "dxf_rotate_extrude each echo else everything false for function group hull if import import_dxf "
        "import_off import_stl include intersection intersection_for let linear_extrude minkowski mirror "
        "module multmatrix nothing offset parent_module path polygon polyhedron projection render resize rotate "
        "rotate_extrude scale segment sphere square surface text translate true undef union use");
    return std::set<std::string>{std::istream_iterator<std::string>(all), {}};
  }();
  return words;
}

std::string list(const Eigen::Vector3d& vector, const script::NumberFormat& number) {
  return fmt::format("[{}]", number(vector));
}

Eigen::Vector3d rotation_angles(const Primitive& primitive) {
  const Eigen::Matrix3d matrix = primitive.pose.orientation.toRotationMatrix();
  if (primitive.displacement) return euler_angles(matrix);
  if (std::holds_alternative<Sphere>(primitive.shape)) return Eigen::Vector3d::Zero();
  const auto* revolution = std::get_if<Revolution>(&primitive.shape);
  const bool is_round =
      std::holds_alternative<Cylinder>(primitive.shape) || std::holds_alternative<Cone>(primitive.shape) ||
      std::holds_alternative<Torus>(primitive.shape) || (revolution != nullptr && is_full_turn(*revolution));
  return is_round ? axis_angles(matrix.col(2)) : euler_angles(matrix);
}

std::string Parameters::add(const std::string& what, const std::string& value) {
  std::string name = variables_.take(solid_ + "_" + what);
  lines_ += fmt::format("{} = {};\n", name, value);
  return name;
}

std::string Parameters::section() const {
  return lines_.empty() ? std::string() : fmt::format("\n/* [{}] */\n{}", solid_, lines_);
}

std::optional<double> pinhole_of(const Torus& torus, int facets) {
  constexpr double k_least = 1e-4;
  // OpenSCAD snaps corners to a grid, where those around the pinhole must stay apart.
  constexpr double k_corner_distance = 1.2e-5;
  constexpr double k_most = 0.1;  // in units that are too small, all corners coincide
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
    // OpenSCAD's faces run clockwise seen from outside.
    faces.push_back(fmt::format("[{}]", fmt::join(face.rbegin(), face.rend(), ", ")));
  }
  return fmt::format("points = [{}],{}faces = [{}]", fmt::join(points, ", "), separator, fmt::join(faces, ", "));
}

}  // namespace cloud2csg::openscad
