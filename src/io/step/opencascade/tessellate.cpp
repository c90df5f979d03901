#include "io/step/opencascade/tessellate.hpp"

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>

namespace cloud2csg::brep {
namespace {

// However small it is, a circle has 18 facets.
constexpr double k_widest_turn = 0.35;

/// Corners by their place: the kernel gives those of an edge the same coordinates in both faces.
class Corners {
 public:
  explicit Corners(TriangleMesh& mesh) : mesh_(mesh) {}

  std::uint32_t at(const gp_Pnt& point) {
    const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto [known, is_new] = index_of_.try_emplace({point.X(), point.Y(), point.Z()}, next);
    if (is_new) mesh_.vertices.push_back({point.X(), point.Y(), point.Z()});
    return known->second;
  }

 private:
  TriangleMesh& mesh_;
  std::map<std::array<double, 3>, std::uint32_t> index_of_ = {};
};

void add_face(const TopoDS_Face& face, Corners& corners, TriangleMesh& mesh) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
  if (triangulation.IsNull()) throw std::runtime_error("the kernel finds no triangles for a face");
  std::vector<std::uint32_t> corner_of;
  for (int i = 1; i <= triangulation->NbNodes(); ++i) {
    corner_of.push_back(corners.at(triangulation->Node(i).Transformed(location.Transformation())));
  }
  for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
    std::array<int, 3> nodes{};
    triangulation->Triangle(i).Get(nodes[0], nodes[1], nodes[2]);
    if (face.Orientation() == TopAbs_REVERSED) std::swap(nodes[1], nodes[2]);
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = corner_of[static_cast<std::size_t>(nodes[k] - 1)];
    // At the poles of a sphere and the tip of a cone, where an edge is a point.
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    mesh.triangles.push_back(triangle);
  }
}

}  // namespace

TriangleMesh tessellate(const Bodies& bodies, double deviation) {
  TriangleMesh mesh;
  for (const Body& body : bodies) {
    const BRepMesh_IncrementalMesh triangulate(body.shape, deviation, false, k_widest_turn, false);
    Corners corners(mesh);
    for (TopExp_Explorer faces(body.shape, TopAbs_FACE); faces.More(); faces.Next()) {
      add_face(TopoDS::Face(faces.Current()), corners, mesh);
    }
  }
  return mesh;
}

}  // namespace cloud2csg::brep
