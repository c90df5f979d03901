#include <fmt/format.h>

#include <array>
#include <utility>

#include "cloud2csg/export.hpp"
#include "core/primitive/shape.hpp"
#include "io/scripts/python_body.hpp"

namespace cloud2csg {
namespace {

using script::exact;

// The placement centres FreeCAD's boxes, which begin at a corner, and its cylinders and cones, which begin at the lower
// end. MultiCommon of more than two operands differs between versions of FreeCAD.
constexpr std::array k_freecad_functions{
    script::Function{" = box(", R"(def box(label, size, position, rotation=(0, 0, 0, 1)):
    x, y, z = size
    return add("Part::Box", label, at(position, rotation, (-x / 2, -y / 2, -z / 2)), Length=x, Width=y, Height=z)
)"},
    script::Function{" = sphere(", R"(def sphere(label, radius, position, rotation=(0, 0, 0, 1)):
    return add("Part::Sphere", label, at(position, rotation), Radius=radius)
)"},
    script::Function{" = cylinder(", R"(def cylinder(label, radius, height, position, rotation=(0, 0, 0, 1)):
    return add("Part::Cylinder", label, at(position, rotation, (0, 0, -height / 2)), Radius=radius, Height=height)
)"},
    script::Function{" = cone(", R"(def cone(label, bottom, top, height, position, rotation=(0, 0, 0, 1)):
    place = at(position, rotation, (0, 0, -height / 2))
    return add("Part::Cone", label, place, Radius1=bottom, Radius2=top, Height=height)
)"},
    script::Function{" = torus(", R"(def torus(label, major, minor, position, rotation=(0, 0, 0, 1)):
    return add("Part::Torus", label, at(position, rotation), Radius1=major, Radius2=minor)
)"},
    script::Function{" = extrusion(", R"(def extrusion(label, regions, height, position, rotation=(0, 0, 0, 1)):
    faces = faces_of(regions, lambda x, y: FreeCAD.Vector(x, y, -height / 2))
    return swept(label, [face.extrude(FreeCAD.Vector(0, 0, height)) for face in faces], position, rotation)
)"},
    script::Function{" = revolution(", R"(def revolution(label, regions, angle, position, rotation=(0, 0, 0, 1)):
    faces = faces_of(regions, lambda x, y: FreeCAD.Vector(x, 0, y))
    axis = FreeCAD.Vector(0, 0, 1)
    return swept(label, [face.revolve(FreeCAD.Vector(0, 0, 0), axis, angle) for face in faces], position, rotation)
)"},
    script::Function{" = polyhedron(", R"(def polyhedron(label, shells, position, rotation=(0, 0, 0, 1)):
    shape = None
    for points, faces in shells:
        corners = [FreeCAD.Vector(*point) for point in points]
        outlines = [Part.makePolygon([corners[i] for i in face + face[:1]]) for face in faces]
        shell = Part.makeShell([Part.Face(outline) for outline in outlines])
        shell.sewShape()
        solid = Part.Solid(shell)
        if solid.Volume < 0:  # a hole in one before
            solid.reverse()
            shape = shape.cut(solid)
        else:
            shape = solid if shape is None else shape.fuse(solid)
    thing = add("Part::Feature", label, at(position, rotation))
    thing.Shape = shape
    thing.Placement = at(position, rotation)
    return thing
)"},
    script::Function{"union(", R"(def union(*operands):
    return combine("Part::MultiFuse", "Union", operands, Shapes=list(operands))
)"},
    script::Function{"common(", R"(def common(first, *others):
    for other in others:  # in pairs: MultiCommon of more differs between versions of FreeCAD
        first = combine("Part::MultiCommon", "Common", (first, other), Shapes=[first, other])
    return first
)"},
    script::Function{"cut(", R"(def cut(base, *tools):
    tool = tools[0] if len(tools) == 1 else combine("Part::MultiFuse", "Removed", tools, Shapes=list(tools))
    return combine("Part::Cut", "Cut", (base, tool), Base=base, Tool=tool)
)"}};

constexpr const char* k_freecad_head =
    R"(# Run it in FreeCAD (Macro > Macros...), or without a window: freecadcmd FILE.FCMacro
# A length of 1 is one millimetre in FreeCAD. Rotations are quaternions: x, y, z, w.
import FreeCAD
import Part

document = FreeCAD.newDocument("Part")


def at(position, rotation, corner=(0, 0, 0)):
    place = FreeCAD.Placement(FreeCAD.Vector(*position), FreeCAD.Rotation(*rotation))
    return place.multiply(FreeCAD.Placement(FreeCAD.Vector(*corner), FreeCAD.Rotation()))


def add(kind, label, placement, **properties):
    thing = document.addObject(kind, kind.split("::")[1])
    thing.Label = label
    thing.Placement = placement
    for name, value in properties.items():
        setattr(thing, name, value)
    return thing
)";

constexpr const char* k_combine = R"(

def combine(kind, label, operands, **properties):
    for operand in operands:
        operand.Visibility = False
    return add(kind, label, FreeCAD.Placement(), **properties)
)";

constexpr const char* k_profile = R"(

def path(corners, place):
    """A wire. A corner (x, y, bulge) starts an arc; the bulge is tan(angle / 4), positive if it turns left."""
    edges = []
    for (x, y, *bulge), (u, v, *_) in zip(corners, corners[1:] + corners[:1]):
        if bulge:
            middle = place((x + u + bulge[0] * (v - y)) / 2, (y + v - bulge[0] * (u - x)) / 2)
            edges.append(Part.Arc(place(x, y), middle, place(u, v)).toShape())
        else:
            edges.append(Part.LineSegment(place(x, y), place(u, v)).toShape())
    return Part.Wire(edges)


def faces_of(regions, place):
    return [Part.Face([path(corners, place) for corners in region]) for region in regions]


def swept(label, solids, position, rotation):
    thing = add("Part::Feature", label, at(position, rotation))
    thing.Shape = solids[0].fuse(solids[1:]) if solids[1:] else solids[0]
    thing.Placement = at(position, rotation)
    return thing
)";

constexpr const char* k_freecad_tail = R"(part.Label = "part"
document.recompute()
if FreeCAD.GuiUp:
    FreeCAD.Gui.SendMsgToActiveView("ViewFit")
)";

std::set<std::string> freecad_reserved_names() {
  std::set<std::string> names = script::python_keywords();
  names.insert({"FreeCAD",  "Part",    "document",  "at",         "add",   "combine",    "part",
                "box",      "sphere",  "cylinder",  "cone",       "torus", "polyhedron", "path",
                "faces_of", "swept",   "extrusion", "revolution", "zip",   "union",      "common",
                "cut",      "setattr", "list",      "len"});
  return names;
}

struct Making {
  const char* function;
  std::string sizes;
};

/// `lists`: the variable with the regions or shells.
Making making_of(const brep::KernelSolid& solid, const std::string& lists) {
  return std::visit(
      Overloaded{
          [](const Box& box) -> Making {
            return {"box", "size=" + exact(box.size)};
          },
          [](const Sphere& sphere) -> Making {
            return {"sphere", "radius=" + exact(sphere.radius)};
          },
          [](const Cylinder& cylinder) -> Making {
            return {"cylinder", fmt::format("radius={}, height={}", exact(cylinder.radius), exact(cylinder.height))};
          },
          [](const Cone& cone) -> Making {
            return {"cone", fmt::format("bottom={}, top={}, height={}", exact(cone.radius_bottom),
                                        exact(cone.radius_top), exact(cone.height))};
          },
          [](const Torus& torus) -> Making {
            return {"torus", fmt::format("major={}, minor={}", exact(torus.major_radius), exact(torus.minor_radius))};
          },
          [&lists](const brep::SweptProfile& swept) -> Making {
            if (!swept.height) return {"revolution", fmt::format("{}, angle={}", lists, exact(swept.angle_deg))};
            return {"extrusion", fmt::format("{}, height={}", lists, exact(*swept.height))};
          },
          [&lists](const brep::Facets& /*facets*/) -> Making {
            return {"polyhedron", lists};
          }},
      solid.shape);
}

script::SolidText solid_text(const std::string& name, const std::string& label, const brep::KernelSolid& solid,
                             script::UniqueNames& names) {
  script::SolidText text;
  std::string lists;
  const auto add_lists = [&](const char* what, const std::string& value) {
    lists = names.take(name + what);
    text.parameters = fmt::format("{} = {}\n", lists, value);
  };
  if (const auto* facets = std::get_if<brep::Facets>(&solid.shape)) add_lists("_shells", script::shells_text(*facets));
  if (const auto* swept = std::get_if<brep::SweptProfile>(&solid.shape)) {
    add_lists("_regions", script::regions_text(swept->regions));
  }
  const Making making = making_of(solid, lists);
  const Eigen::Quaterniond& q = solid.pose.orientation;
  const std::string rotation = q.vec().isZero(0) ? ""
                                                 : fmt::format(", rotation=({}, {}, {}, {})", exact(q.x()),
                                                               exact(q.y()), exact(q.z()), exact(q.w()));
  text.statement = fmt::format("{} = {}({}, {}, position={}{})\n", name, making.function, script::python_string(label),
                               making.sizes, exact(solid.pose.position), rotation);
  return text;
}

script::Dialect dialect(script::UniqueNames& names) {
  using Operands = std::span<const std::string>;
  return {.solid = [&names](const std::string& name, const std::string& label,
                            const brep::KernelSolid& solid) { return solid_text(name, label, solid, names); },
          .unite = [](Operands operands) { return fmt::format("union({})", script::arguments(operands)); },
          .common = [](Operands operands) { return fmt::format("common({})", script::arguments(operands)); },
          .cut =
              [](const std::string& base, Operands operands) {
                std::vector<std::string> all{base};
                all.insert(all.end(), operands.begin(), operands.end());
                return fmt::format("cut({})", script::arguments(all));
              }};
}

std::string freecad_functions(const std::string& statements) {
  std::string helpers;
  bool combines = false;
  bool sweeps = false;
  for (const script::Function& helper : k_freecad_functions) {
    if (statements.find(helper.call) == std::string::npos) continue;
    const bool is_operation = std::string_view(helper.text).find("combine(") != std::string_view::npos;
    if (is_operation && !std::exchange(combines, true)) helpers += k_combine;
    const bool is_swept = std::string_view(helper.text).find("swept(") != std::string_view::npos;
    if (is_swept && !std::exchange(sweeps, true)) helpers += k_profile;
    helpers += "\n\n";
    helpers += helper.text;
  }
  return helpers;
}

}  // namespace

std::string to_freecad_macro(const Model& model, const ScriptOptions& options) {
  validate(options);
  const script::Plan plan = script::plan_script(model);
  script::UniqueNames names(freecad_reserved_names());
  const script::PythonBody body =
      script::python_body(plan, model.primitives, options.facet_resolution, names, dialect(names));
  return script::comment(options.comment, "# ") + k_freecad_head + freecad_functions(body.solids + body.operations) +
         "\n\n" + body.parameters + body.solids + "\n" + body.operations + k_freecad_tail;
}

}  // namespace cloud2csg
