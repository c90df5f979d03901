#include "io/step/opencascade/make_body.hpp"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <Convert_ParameterisationType.hxx>
#include <Eigen/Core>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Precision.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <gp_Ax2.hxx>
#include <gp_Ax3.hxx>
#include <gp_Pln.hxx>
#include <gp_Pnt.hxx>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "core/base/disjoint_sets.hpp"
#include "core/primitive/profile.hpp"
#include "io/step/kernel.hpp"

namespace cloud2csg::brep {
namespace {

[[nodiscard]] inline gp_Pnt point_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

using CornerIndices = std::array<std::size_t, 3>;

gp_Dir direction_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

TopoDS_Edge arc(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const TopoDS_Vertex& start,
                const TopoDS_Vertex& end) {
  const gp_Ax2 axes(gp_Pnt(0, 0, 0), direction_of(from.cross(to)), direction_of(from));
  return BRepBuilderAPI_MakeEdge(new Geom_Circle(axes, from.norm()), start, end).Edge();
}

/// A sphere at the origin, made of four curved triangles. Each has its poles and seam outside itself, so cuts leave
/// plain edges only. STEP readers misread spheres that are cut around both poles. @throws Standard_Failure
TopoDS_Shape split_sphere(double radius) {
  // A tetrahedron rotated off all axes.
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.83, 0.31, -0.23, 0.41).normalized();
  constexpr std::array<std::array<int, 3>, 4> k_corners{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};
  constexpr std::array<CornerIndices, 4> k_faces{{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
  std::array<Eigen::Vector3d, 4> corners;
  std::array<TopoDS_Vertex, 4> vertices;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = turn * (radius * Eigen::Vector3d(k_corners[i][0], k_corners[i][1], k_corners[i][2]).normalized());
    vertices[i] = BRepBuilderAPI_MakeVertex(point_of(corners[i])).Vertex();
  }
  std::array<std::array<TopoDS_Edge, 4>, 4> edges;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t j = i + 1; j < corners.size(); ++j) {
      edges[i][j] = arc(corners[i], corners[j], vertices[i], vertices[j]);
      edges[j][i] = TopoDS::Edge(edges[i][j].Reversed());
    }
  }
  const BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  for (const auto& [a, b, c] : k_faces) {
    const Eigen::Vector3d middle = corners[a] + corners[b] + corners[c];
    const gp_Ax3 axes(gp_Pnt(0, 0, 0), direction_of(corners[a].cross(middle)), direction_of(-middle));
    BRepBuilderAPI_MakeWire wire(edges[a][b], edges[b][c], edges[c][a]);
    builder.Add(shell, BRepBuilderAPI_MakeFace(new Geom_SphericalSurface(axes, radius), wire.Wire(), true).Face());
  }
  shell.Closed(true);
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  // Adds the edges' curves in the faces' parameters.
  const Handle(ShapeFix_Shape) fix = new ShapeFix_Shape(solid);
  fix->Perform();
  return fix->Shape();
}

using Face = std::vector<std::uint32_t>;
using EdgeKey = std::pair<std::uint32_t, std::uint32_t>;  ///< smaller corner first

EdgeKey key_of(std::uint32_t from, std::uint32_t to) {
  return {std::min(from, to), std::max(from, to)};
}

/// Twice the face's area along its normal.
Eigen::Vector3d area_of(const Facets& facets, const Face& face) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  const Eigen::Vector3d first = facets.corners[face[0]];
  for (std::size_t i = 2; i < face.size(); ++i) {
    area += (facets.corners[face[i - 1]] - first).cross(facets.corners[face[i]] - first);
  }
  return area;
}

/// Faces that are connected by edges, by piece.
std::vector<std::vector<std::size_t>> pieces_of(const Facets& facets) {
  DisjointSets sets(facets.faces.size());
  std::map<EdgeKey, std::size_t> first_face;
  for (std::size_t f = 0; f < facets.faces.size(); ++f) {
    const Face& face = facets.faces[f];
    for (std::size_t i = 0; i < face.size(); ++i) {
      const auto [entry, is_new] = first_face.try_emplace(key_of(face[i], face[(i + 1) % face.size()]), f);
      if (!is_new) sets.join(f, entry->second);
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> by_root;
  for (std::size_t f = 0; f < facets.faces.size(); ++f) by_root[sets.root(f)].push_back(f);
  std::vector<std::vector<std::size_t>> pieces;
  pieces.reserve(by_root.size());
  for (auto& [_, faces] : by_root) pieces.push_back(std::move(faces));
  return pieces;
}

class ShellBuilder {
 public:
  explicit ShellBuilder(const Facets& facets) : facets_(facets), vertices_(facets.corners.size()) {}

  TopoDS_Shell shell(const std::vector<std::size_t>& faces) {
    TopoDS_Shell shell;
    builder_.MakeShell(shell);
    for (const std::size_t f : faces) {
      const Face& face = facets_.faces[f];
      const Eigen::Vector3d area = area_of(facets_, face);
      if (area.norm() > k_least_area) builder_.Add(shell, make_face(face, area));
    }
    shell.Closed(true);
    return shell;
  }

 private:
  static constexpr double k_least_area = 1e-14;  // squares of the kernel's tolerance

  TopoDS_Face make_face(const Face& corners, const Eigen::Vector3d& area) {
    TopoDS_Wire wire;
    builder_.MakeWire(wire);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      builder_.Add(wire, edge(corners[i], corners[(i + 1) % corners.size()]));
    }
    wire.Closed(true);
    const gp_Pln plane(point_of(facets_.corners[corners[0]]), gp_Dir(area.x(), area.y(), area.z()));
    return BRepBuilderAPI_MakeFace(plane, wire, true).Face();
  }

  TopoDS_Edge edge(std::uint32_t from, std::uint32_t to) {
    TopoDS_Edge& edge = edges_[key_of(from, to)];
    if (edge.IsNull()) edge = BRepBuilderAPI_MakeEdge(vertex(std::min(from, to)), vertex(std::max(from, to))).Edge();
    return from < to ? edge : TopoDS::Edge(edge.Reversed());
  }

  const TopoDS_Vertex& vertex(std::uint32_t corner) {
    TopoDS_Vertex& vertex = vertices_[corner];
    if (vertex.IsNull()) vertex = BRepBuilderAPI_MakeVertex(point_of(facets_.corners[corner])).Vertex();
    return vertex;
  }

  const Facets& facets_;
  const BRep_Builder builder_ = {};
  std::vector<TopoDS_Vertex> vertices_;
  std::map<EdgeKey, TopoDS_Edge> edges_ = {};
};

/// A closed piece of the surface; its volume is negative for a hollow.
struct Piece {
  TopoDS_Shell shell;
  AlignedBox box;
  double volume;
};

Piece make_piece(const Facets& facets, const std::vector<std::size_t>& faces, ShellBuilder& builder) {
  Piece piece{.shell = builder.shell(faces), .box = {}, .volume = 0};
  const Eigen::Vector3d origin = facets.corners[facets.faces[faces[0]][0]];
  for (const std::size_t f : faces) {
    for (const std::uint32_t corner : facets.faces[f]) piece.box.extend(facets.corners[corner]);
    piece.volume += area_of(facets, facets.faces[f]).dot(facets.corners[facets.faces[f][0]] - origin) / 6;
  }
  return piece;
}

/// The smallest solid around a hollow, by bounding boxes; null if there is none.
TopoDS_Solid* solid_around(const Piece& hollow, const std::vector<Piece>& outer, std::vector<TopoDS_Solid>& solids) {
  std::size_t best = outer.size();
  for (std::size_t i = 0; i < outer.size(); ++i) {
    if (!outer[i].box.contains(hollow.box)) continue;
    if (best == outer.size() || outer[i].box.volume() < outer[best].box.volume()) best = i;
  }
  return best == outer.size() ? nullptr : &solids[best];
}

/// Solids of flat faces. Each piece connected by edges becomes a solid. Pieces turned inside out become hollows of the
/// smallest solid around them. Drops faces too thin for a plane. O(faces + hollows x solids) @throws Standard_Failure
std::vector<TopoDS_Shape> solids_of_facets(const Facets& facets) {
  ShellBuilder shells(facets);
  std::vector<Piece> outer;
  std::vector<Piece> hollows;
  for (const std::vector<std::size_t>& faces : pieces_of(facets)) {
    Piece piece = make_piece(facets, faces, shells);
    if (piece.volume != 0) (piece.volume > 0 ? outer : hollows).push_back(std::move(piece));
  }
  const BRep_Builder builder;
  std::vector<TopoDS_Solid> solids(outer.size());
  for (std::size_t i = 0; i < outer.size(); ++i) {
    builder.MakeSolid(solids[i]);
    builder.Add(solids[i], outer[i].shell);
  }
  for (const Piece& hollow : hollows) {
    if (TopoDS_Solid* const solid = solid_around(hollow, outer, solids)) builder.Add(*solid, hollow.shell);
  }
  return {solids.begin(), solids.end()};
}

gp_Ax2 axis_from(double height) {
  return {gp_Pnt(0, 0, height), gp_Dir(0, 0, 1)};
}

TopoDS_Shape centred(const Box& box) {
  const Eigen::Vector3d half = 0.5 * box.size;
  return BRepPrimAPI_MakeBox(point_of(-half), point_of(half)).Solid();
}

TopoDS_Shape centred(const Sphere& sphere) {
  return BRepPrimAPI_MakeSphere(sphere.radius).Solid();
}

TopoDS_Shape centred(const Cylinder& cylinder) {
  return BRepPrimAPI_MakeCylinder(axis_from(-0.5 * cylinder.height), cylinder.radius, cylinder.height).Solid();
}

TopoDS_Shape centred(const Cone& cone) {
  // The kernel refuses cones with parallel sides.
  if (std::abs(cone.radius_bottom - cone.radius_top) <= Precision::Confusion()) {
    return centred(Cylinder{.radius = 0.5 * (cone.radius_bottom + cone.radius_top), .height = cone.height});
  }
  return BRepPrimAPI_MakeCone(axis_from(-0.5 * cone.height), cone.radius_bottom, cone.radius_top, cone.height).Solid();
}

/// The kernel refuses tori without a hole, so a pinhole remains; relative to the tube's radius.
constexpr double k_pinhole = 1e-5;

TopoDS_Shape centred(const Torus& torus) {
  const double minor = std::min(torus.minor_radius, (1 - k_pinhole) * torus.major_radius);
  return BRepPrimAPI_MakeTorus(torus.major_radius, minor).Solid();
}

TopoDS_Shape placed(const TopoDS_Shape& shape, const Pose& pose) {
  gp_Trsf motion;
  const Eigen::Quaterniond& q = pose.orientation;
  motion.SetTransformation(gp_Quaternion(q.x(), q.y(), q.z(), q.w()),
                           gp_Vec(pose.position.x(), pose.position.y(), pose.position.z()));
  // Applies the motion to the geometry, because some kernel operations lose precision with nested locations.
  return BRepBuilderAPI_Transform(shape, motion, true).Shape();
}

/// Places a profile's plane in space.
using PlaceOf = std::function<gp_Pnt(const Eigen::Vector2d&)>;

/// The curve of an arc. Turned about x = 0, a circle gives a torus if its angles count from the far side of the axis.
/// The kernel knows no torus that cuts itself, so such an arc becomes a spline, which is exact as well.
Handle(Geom_Curve) curve_of(const ProfileSegment& arc, const PlaceOf& place, bool is_turned) {
  const gp_Pnt centre = place(arc.centre);
  const gp_Vec to_start(centre, place(arc.start));
  const gp_Vec to_quarter(centre, place(arc.centre + (arc.angle > 0 ? 1 : -1) * to_the_left(arc.start - arc.centre)));
  const gp_Dir normal(to_start.Crossed(to_quarter));
  const bool is_sphere = std::abs(arc.centre.x()) < Precision::Confusion();
  if (!is_turned || is_sphere || arc.centre.x() > (1 + k_pinhole) * arc.radius) {
    const gp_Vec outward(centre, place(arc.centre + Eigen::Vector2d::UnitX()));
    return new Geom_Circle(gp_Ax2(centre, normal, gp_Dir(is_turned ? outward : to_start)), arc.radius);
  }
  Handle(Geom_Curve) circle = new Geom_Circle(gp_Ax2(centre, normal, gp_Dir(to_start)), arc.radius);
  // A parameter close to the angle: with others, the kernel's measure of the volume is off by up to .4 %.
  Handle(Geom_Curve) spline =
      GeomConvert::CurveToBSplineCurve(new Geom_TrimmedCurve(circle, 0, std::abs(arc.angle)), Convert_QuasiAngular);
  return spline;
}

/// Whether two arcs make a circle.
bool is_whole_circle(const std::vector<ProfileSegment>& path) {
  if (path.size() != 2 || !path[0].is_arc() || !path[1].is_arc()) return false;
  return (path[0].centre - path[1].centre).norm() <= 1e-9 * path[0].radius;
}

TopoDS_Wire wire_of(const std::vector<ProfileSegment>& path, const PlaceOf& place, bool is_turned) {
  // Halves of a cylinder would have to be joined again, which may never end (see with_joined_faces()).
  if (is_whole_circle(path)) {
    const Handle(Geom_Curve) circle = curve_of(path[0], place, is_turned);
    if (circle->IsClosed()) return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire();
  }
  std::vector<TopoDS_Vertex> corners;
  corners.reserve(path.size());
  for (const ProfileSegment& s : path) corners.push_back(BRepBuilderAPI_MakeVertex(place(s.start)).Vertex());
  BRepBuilderAPI_MakeWire wire;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const ProfileSegment& s = path[i];
    const TopoDS_Vertex& start = corners[i];
    const TopoDS_Vertex& end = corners[(i + 1) % path.size()];
    wire.Add(s.is_arc() ? BRepBuilderAPI_MakeEdge(curve_of(s, place, is_turned), start, end).Edge()
                        : BRepBuilderAPI_MakeEdge(start, end).Edge());
  }
  return wire.Wire();
}

double angle_of(const SweptProfile& swept) {
  return swept.angle_deg / 180 * std::numbers::pi;
}

TopoDS_Shape swept_solid(const TopoDS_Face& face, const SweptProfile& swept) {
  if (swept.height) return BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, *swept.height)).Shape();
  const gp_Ax1 axis(gp_Pnt(0, 0, 0), gp_Dir(0, 0, -1));
  if (swept.angle_deg < 360) return BRepPrimAPI_MakeRevol(face, axis, angle_of(swept)).Shape();
  return BRepPrimAPI_MakeRevol(face, axis).Shape();
}

Bodies bodies_of(const SweptProfile& swept, const Pose& pose) {
  const double half = 0.5 * swept.height.value_or(0);
  // The face is at the end of the turn, which runs backwards from there: that is where the face looks.
  const double angle = swept.angle_deg < 360 ? angle_of(swept) : 0;
  const Eigen::Vector2d start(std::cos(angle), std::sin(angle));
  const PlaceOf place = [&](const Eigen::Vector2d& p) {
    return swept.height ? gp_Pnt(p.x(), p.y(), -half) : gp_Pnt(p.x() * start.x(), p.x() * start.y(), p.y());
  };
  Bodies bodies;
  for (const ProfileRegion& region : swept.regions) {
    BRepBuilderAPI_MakeFace face(wire_of(region.outline, place, !swept.height), true);
    for (const auto& hole : region.holes) face.Add(wire_of(hole, place, !swept.height));
    bodies.push_back(body_of(placed(swept_solid(face.Face(), swept), pose)));
  }
  return bodies;
}

}  // namespace

Bodies make_bodies(const KernelSolid& solid, SphereForm spheres) {
  const auto* sphere = std::get_if<Sphere>(&solid.shape);
  if (sphere != nullptr && spheres == SphereForm::split) {
    return {body_of(placed(split_sphere(sphere->radius), solid.pose))};
  }
  if (const auto* facets = std::get_if<Facets>(&solid.shape)) {
    Facets moved = *facets;
    for (Eigen::Vector3d& corner : moved.corners) corner = solid.pose.to_world(corner);
    return make_bodies(moved);
  }
  return std::visit(
      [&](const auto& shape) -> Bodies {
        using Type = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Type, Facets>) {
          return {};
        } else if constexpr (std::is_same_v<Type, SweptProfile>) {
          return bodies_of(shape, solid.pose);
        } else {
          return {body_of(placed(centred(shape), solid.pose))};
        }
      },
      solid.shape);
}

Bodies make_bodies(const Facets& facets) {
  Bodies bodies;
  for (const TopoDS_Shape& solid : solids_of_facets(facets)) bodies.push_back(body_of(solid));
  return bodies;
}

Body make_block(const AlignedBox& box) {
  return body_of(BRepPrimAPI_MakeBox(point_of(box.min()), point_of(box.max())).Solid());
}

}  // namespace cloud2csg::brep
