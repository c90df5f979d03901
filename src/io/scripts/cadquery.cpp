#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "cloud2csg/export.hpp"
#include "core/primitive/shape.hpp"
#include "io/scripts/python_body.hpp"

namespace cloud2csg {
namespace {

constexpr std::array k_cadquery_functions{
    script::Function{"= box(", R"(def box(size, position, axis=(0, 0, 1), degrees=0):
    x, y, z = size
    return placed(cq.Solid.makeBox(x, y, z, cq.Vector(-x / 2, -y / 2, -z / 2)), position, axis, degrees)
)"},
    script::Function{"= sphere(", R"(def sphere(radius, position):
    whole = cq.Solid.makeSphere(radius, cq.Vector(0, 0, 0), cq.Vector(0, 0, 1), -90, 90, 360)
    return placed(whole, position)
)"},
    script::Function{"= cylinder(", R"(def cylinder(radius, height, position, axis=(0, 0, 1), degrees=0):
    solid = cq.Solid.makeCylinder(radius, height, cq.Vector(0, 0, -height / 2))
    return placed(solid, position, axis, degrees)
)"},
    script::Function{"= cone(", R"(def cone(radius_bottom, radius_top, height, position, axis=(0, 0, 1), degrees=0):
    solid = cq.Solid.makeCone(radius_bottom, radius_top, height, cq.Vector(0, 0, -height / 2))
    return placed(solid, position, axis, degrees)
)"},
    script::Function{"= torus(", R"(def torus(major_radius, minor_radius, position, axis=(0, 0, 1), degrees=0):
    return placed(cq.Solid.makeTorus(major_radius, minor_radius), position, axis, degrees)
)"},
    script::Function{"= extrusion(", R"(def extrusion(regions, height, position, axis=(0, 0, 1), degrees=0):
    def place(x, y):
        return cq.Vector(x, y, -height / 2)
    solids = [cq.Solid.extrudeLinear(path(outline, place), [path(hole, place) for hole in holes],
                                     cq.Vector(0, 0, height)) for outline, *holes in regions]
    return placed(solids[0].fuse(*solids[1:]) if solids[1:] else solids[0], position, axis, degrees)
)"},
    script::Function{"= revolution(", R"(def revolution(regions, angle, position, axis=(0, 0, 1), degrees=0):
    def place(x, y):
        return cq.Vector(x, 0, y)
    solids = [cq.Solid.revolve(path(outline, place), [path(hole, place) for hole in holes], angle,
                               cq.Vector(0, 0, 0), cq.Vector(0, 0, 1)) for outline, *holes in regions]
    return placed(solids[0].fuse(*solids[1:]) if solids[1:] else solids[0], position, axis, degrees)
)"},
    script::Function{"= polyhedron(", R"(def polyhedron(shells, position, axis=(0, 0, 1), degrees=0):
    solid = None
    for points, faces in shells:
        corners = [cq.Vector(*point) for point in points]
        outlines = [cq.Wire.makePolygon([corners[i] for i in face], close=True) for face in faces]
        shell = cq.Shell.makeShell([cq.Face.makeFromWires(outline) for outline in outlines])
        piece = cq.Solid.makeSolid(shell)
        if solid is None:
            solid = piece
        elif turns_inward(points, faces):
            solid = solid.cut(piece)
        else:
            solid = solid.fuse(piece)
    return placed(solid, position, axis, degrees)


def turns_inward(points, faces):
    volume = 0
    for face in faces:
        a = cq.Vector(*points[face[0]])
        for i, j in zip(face[1:], face[2:]):
            volume += a.dot(cq.Vector(*points[i]).cross(cq.Vector(*points[j])))
    return volume < 0
)"}};

constexpr const char* k_cadquery_head = R"(# For CadQuery 2.2 or later. The result is `part`: CQ-editor shows it;
# cq.exporters.export(cq.Workplane(part), "part.step") writes it.
# Lengths are in the model's units; a solid is turned about its axis through the origin, by degrees, then moved.
import cadquery as cq
)";

constexpr const char* k_placed = R"(

def placed(solid, position, axis=(0, 0, 1), degrees=0):
    return solid.moved(cq.Location(cq.Vector(*position), cq.Vector(*axis), degrees))
)";

constexpr const char* k_cadquery_tail = R"(
if "show_object" in globals():
    show_object(part)
)";

constexpr const char* k_path = R"(

def path(corners, place):
    """A wire. A corner (x, y, bulge) starts an arc; the bulge is tan(angle / 4), positive if it turns left."""
    edges = []
    for (x, y, *bulge), (u, v, *_) in zip(corners, corners[1:] + corners[:1]):
        if bulge:
            middle = place((x + u + bulge[0] * (v - y)) / 2, (y + v - bulge[0] * (u - x)) / 2)
            edges.append(cq.Edge.makeThreePointArc(place(x, y), middle, place(u, v)))
        else:
            edges.append(cq.Edge.makeLine(place(x, y), place(u, v)))
    return cq.Wire.assembleEdges(edges)
)";

std::set<std::string> cadquery_reserved_names() {
  std::set<std::string> names = script::python_keywords();
  names.insert({"cq", "part", "path", "extrusion", "revolution", "placed", "turns_inward", "box", "sphere", "cylinder",
                "cone", "torus", "polyhedron", "show_object", "globals", "zip", "enumerate"});
  return names;
}

/// The least rotation that places a solid: none for a sphere, that of the axis for other solids of revolution.
Eigen::AngleAxisd turn_of(const brep::KernelSolid& solid) {
  const Eigen::Quaterniond& q = solid.pose.orientation;
  if (std::holds_alternative<Sphere>(solid.shape)) return {0, Eigen::Vector3d::UnitZ()};
  if (std::holds_alternative<Box>(solid.shape) || std::holds_alternative<brep::SweptProfile>(solid.shape) ||
      std::holds_alternative<brep::Facets>(solid.shape)) {
    return Eigen::AngleAxisd(q);
  }
  Eigen::Vector3d axis = q * Eigen::Vector3d::UnitZ();
  // A cylinder or torus looks the same upside down, a cone does not.
  if (!std::holds_alternative<Cone>(solid.shape) && axis.z() < 0) axis = -axis;
  return Eigen::AngleAxisd(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis));
}

/// Writes a solid's variables and the statement that makes the solid from them.
class SolidWriter {
 public:
  SolidWriter(const std::string& name, script::UniqueNames& names, const script::NumberFormat& number)
      : name_(name), names_(names), number_(number) {}

  script::SolidText write(const std::string& label, const brep::KernelSolid& solid) {
    const std::string function = std::visit(*this, solid.shape);
    add("position", vector(solid.pose.position));
    const Eigen::AngleAxisd turn = turn_of(solid);
    if (const double degrees = script::degrees_of(turn.angle()); std::abs(degrees) > 1e-10) {
      const script::NumberFormat plain(1.0);
      add("axis", fmt::format("({})", plain(Eigen::Vector3d(turn.axis()))));
      add("degrees", plain(degrees));
    }
    return {.parameters = "\n" + script::comment(label, "# ") + variables_,
            .statement = fmt::format("{} = {}({})\n", name_, function, script::arguments(arguments_))};
  }

  std::string operator()(const Box& box) {
    add("size", vector(box.size));
    return "box";
  }
  std::string operator()(const Sphere& sphere) {
    add("radius", number_(sphere.radius));
    return "sphere";
  }
  std::string operator()(const Cylinder& cylinder) {
    add("radius", number_(cylinder.radius));
    add("height", number_(cylinder.height));
    return "cylinder";
  }
  std::string operator()(const Cone& cone) {
    add("radius_bottom", number_(cone.radius_bottom));
    add("radius_top", number_(cone.radius_top));
    add("height", number_(cone.height));
    return "cone";
  }
  std::string operator()(const Torus& torus) {
    add("major_radius", number_(torus.major_radius));
    add("minor_radius", number_(torus.minor_radius));
    return "torus";
  }
  std::string operator()(const brep::SweptProfile& swept) {
    add("regions", script::regions_text(swept.regions));
    if (swept.height) {
      add("height", number_(*swept.height));
      return "extrusion";
    }
    add("angle", script::NumberFormat(1.0)(swept.angle_deg));
    return "revolution";
  }
  std::string operator()(const brep::Facets& facets) {
    add("shells", script::shells_text(facets));
    return "polyhedron";
  }

 private:
  [[nodiscard]] std::string vector(const Eigen::Vector3d& value) const { return fmt::format("({})", number_(value)); }

  void add(const char* what, const std::string& value) {
    arguments_.push_back(names_.take(fmt::format("{}_{}", name_, what)));
    variables_ += fmt::format("{} = {}\n", arguments_.back(), value);
  }

  const std::string& name_;
  script::UniqueNames& names_;
  const script::NumberFormat& number_;
  std::string variables_ = {};
  std::vector<std::string> arguments_ = {};
};

script::Dialect dialect(script::UniqueNames& names, const script::NumberFormat& number) {
  using Operands = std::span<const std::string>;
  return {.solid = [&names, &number](
                       const std::string& name, const std::string& label,
                       const brep::KernelSolid& solid) { return SolidWriter(name, names, number).write(label, solid); },
          .unite =
              [](Operands operands) {
                return fmt::format("{}.fuse({})", operands.front(), script::arguments(operands.subspan(1)));
              },
          // One at a time: intersect() intersects with the union of several operands.
          .common =
              [](Operands operands) {
                std::string chain = operands.front();
                for (const std::string& operand : operands.subspan(1)) chain += fmt::format(".intersect({})", operand);
                return chain;
              },
          .cut = [](const std::string& base,
                    Operands operands) { return fmt::format("{}.cut({})", base, script::arguments(operands)); }};
}

std::string cadquery_functions(const std::string& statements) {
  std::string helpers = k_placed;
  bool has_paths = false;
  for (const script::Function& helper : k_cadquery_functions) {
    if (statements.find(helper.call) == std::string::npos) continue;
    const bool needs_path = std::string_view(helper.text).find("path(") != std::string_view::npos;
    if (needs_path && !std::exchange(has_paths, true)) helpers += k_path;
    helpers += std::string("\n\n") + helper.text;
  }
  return helpers;
}

}  // namespace

std::string to_cadquery(const Model& model, const ScriptOptions& options) {
  validate(options);
  const script::Plan plan = script::plan_script(model);
  const script::NumberFormat number(plan.everything.sizes().maxCoeff());
  script::UniqueNames names(cadquery_reserved_names());
  const script::PythonBody body =
      script::python_body(plan, model.primitives, options.facet_resolution, names, dialect(names, number));
  return script::comment(options.comment, "# ") + k_cadquery_head + body.parameters + cadquery_functions(body.solids) +
         "\n\n" + body.solids + "\n" + body.operations + k_cadquery_tail;
}

}  // namespace cloud2csg
