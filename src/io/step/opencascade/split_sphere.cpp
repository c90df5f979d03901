#include "io/step/opencascade/split_sphere.hpp"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRep_Builder.hxx>
#include <Geom_Circle.hxx>
#include <Geom_SphericalSurface.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <array>
#include <gp_Ax3.hxx>

#include "cloud2csg/geometry.hpp"
#include "io/step/opencascade/points.hpp"

namespace cloud2csg::brep {
namespace {

using Corners = std::array<std::size_t, 3>;

gp_Dir direction_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Part of a great circle.
TopoDS_Edge arc(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const TopoDS_Vertex& start,
                const TopoDS_Vertex& end) {
  const gp_Ax2 axes(gp_Pnt(0, 0, 0), direction_of(from.cross(to)), direction_of(from));
  return BRepBuilderAPI_MakeEdge(new Geom_Circle(axes, from.norm()), start, end).Edge();
}

}  // namespace

TopoDS_Shape split_sphere(double radius) {
  // A tetrahedron that is turned such that nothing of it is along an axis.
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.83, 0.31, -0.23, 0.41).normalized();
  constexpr std::array<std::array<int, 3>, 4> k_corners{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};
  constexpr std::array<Corners, 4> k_faces{{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
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
  // Adds where the edges are in the parameters of the faces.
  const Handle(ShapeFix_Shape) fix = new ShapeFix_Shape(solid);
  fix->Perform();
  return fix->Shape();
}

}  // namespace cloud2csg::brep
