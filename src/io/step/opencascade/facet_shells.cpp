#include "io/step/opencascade/facet_shells.hpp"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pln.hxx>
#include <map>
#include <utility>

#include "core/base/disjoint_sets.hpp"
#include "io/step/opencascade/points.hpp"

namespace cloud2csg::brep {
namespace {

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

/// Faces that hang together by edges, numbered from 0.
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

/// Makes faces that share their edges.
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

/// A closed piece of the surface: volume is negative for a hollow.
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

/// The smallest solid around a hollow, by boxes; none for one that stands alone.
TopoDS_Solid* solid_around(const Piece& hollow, const std::vector<Piece>& outer, std::vector<TopoDS_Solid>& solids) {
  std::size_t best = outer.size();
  for (std::size_t i = 0; i < outer.size(); ++i) {
    if (!outer[i].box.contains(hollow.box)) continue;
    if (best == outer.size() || outer[i].box.volume() < outer[best].box.volume()) best = i;
  }
  return best == outer.size() ? nullptr : &solids[best];
}

}  // namespace

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

}  // namespace cloud2csg::brep
