#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "cloud2csg/input.hpp"
#include "cloud2csg/mesh.hpp"
#include "core/geometry/facet.hpp"
#include "core/geometry/place_text.hpp"
#include "io/meshes/mesh_faults.hpp"

namespace cloud2csg {
namespace {

struct TurnedTriangles {
  std::size_t disagreeing = 0;  ///< triangles that disagreed with most of their piece
  bool whole = false;           ///< the volume was then negative: all triangles were turned
  std::size_t pieces = 0;       ///< closed pieces, other than cavities, that were still inside out
};

using Eigen::Vector3d;
using Piece = std::vector<std::uint32_t>;  // triangle indices

/// Two triangles at an edge that has no third.
struct Neighbour {
  std::uint32_t triangle;
  bool agrees;  ///< the triangles run through the edge in opposite directions
};
using Neighbours = std::vector<std::vector<Neighbour>>;  // by triangle

Neighbours neighbours_of(const TriangleMesh& mesh) {
  struct Side {
    std::uint32_t low, high, triangle;
    bool is_upward;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = mesh.triangles[t][i];
      const std::uint32_t to = mesh.triangles[t][(i + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& side) { return std::tuple(side.low, side.high, side.triangle); });
  Neighbours neighbours(mesh.triangles.size());
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    const auto is_same = [&](const Side& side) {
      return side.low == sides[begin].low && side.high == sides[begin].high;
    };
    while (end < sides.size() && is_same(sides[end])) ++end;
    if (end - begin != 2) continue;
    const Side& one = sides[begin];
    const Side& other = sides[begin + 1];
    neighbours[one.triangle].push_back({other.triangle, one.is_upward != other.is_upward});
    neighbours[other.triangle].push_back({one.triangle, one.is_upward != other.is_upward});
  }
  return neighbours;
}

void turn(TriangleMesh& mesh, std::uint32_t triangle) {
  std::swap(mesh.triangles[triangle][1], mesh.triangles[triangle][2]);
}

/// The piece of a triangle, and which of its members must be turned to agree with that triangle.
struct Reached {
  Piece triangles;
  std::vector<bool> is_against;
};

Reached reach_from(std::uint32_t first, const Neighbours& neighbours, std::vector<bool>& is_reached) {
  Reached reached{{first}, {false}};
  is_reached[first] = true;
  for (std::size_t k = 0; k < reached.triangles.size(); ++k) {
    for (const Neighbour& next : neighbours[reached.triangles[k]]) {
      if (is_reached[next.triangle]) continue;
      is_reached[next.triangle] = true;
      reached.triangles.push_back(next.triangle);
      reached.is_against.push_back(reached.is_against[k] == next.agrees);
    }
  }
  return reached;
}

/// Turns the part with the smaller area. Returns the number of turned triangles.
std::size_t make_agree(TriangleMesh& mesh, const Reached& reached) {
  double against = 0;
  double all = 0;
  for (std::size_t k = 0; k < reached.triangles.size(); ++k) {
    const double area = doubled_area(mesh, mesh.triangles[reached.triangles[k]]).norm();
    all += area;
    if (reached.is_against[k]) against += area;
  }
  const bool turned_are_against = 2 * against <= all;
  std::size_t turned = 0;
  for (std::size_t k = 0; k < reached.triangles.size(); ++k) {
    if (reached.is_against[k] != turned_are_against) continue;
    turn(mesh, reached.triangles[k]);
    ++turned;
  }
  return turned;
}

double volume_of(const TriangleMesh& mesh, std::span<const std::uint32_t> piece) {
  // An origin near the piece loses little precision far from the origin of coordinates.
  const Vector3d origin = mesh.vertices[mesh.triangles[piece.front()][0]];
  double sum = 0;
  for (const std::uint32_t t : piece) {
    const auto& [a, b, c] = mesh.triangles[t];
    sum += (mesh.vertices[a] - origin).dot((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin));
  }
  return sum / 6;
}

/// Absolute winding number of a piece around a place: sum of solid angles (Van Oosterom and Strackee 1983).
double turns_around(const Vector3d& place, const TriangleMesh& mesh, std::span<const std::uint32_t> piece) {
  double sum = 0;
  for (const std::uint32_t t : piece) {
    const Vector3d a = mesh.vertices[mesh.triangles[t][0]] - place;
    const Vector3d b = mesh.vertices[mesh.triangles[t][1]] - place;
    const Vector3d c = mesh.vertices[mesh.triangles[t][2]] - place;
    const double below =
        a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() + b.dot(c) * a.norm() + c.dot(a) * b.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), below);
  }
  return std::abs(sum) / (4 * std::numbers::pi);
}

/// Whether all vertices of a piece are within the other. An outside piece fails at an early vertex.
bool is_within(const TriangleMesh& mesh, const Piece& piece, const Piece& other) {
  return std::ranges::all_of(
      piece, [&](std::uint32_t t) { return turns_around(mesh.vertices[mesh.triangles[t][0]], mesh, other) > 0.5; });
}

AlignedBox bounds_of(const TriangleMesh& mesh, const Piece& piece) {
  AlignedBox box;
  for (const std::uint32_t t : piece) {
    for (const std::uint32_t corner : mesh.triangles[t]) box.extend(mesh.vertices[corner]);
  }
  return box;
}

/// Turns closed pieces of negative volume, except cavities. Returns their number.
std::size_t turn_pieces(TriangleMesh& mesh, const std::vector<Piece>& pieces) {
  std::vector<AlignedBox> boxes;
  boxes.reserve(pieces.size());
  for (const Piece& piece : pieces) boxes.push_back(bounds_of(mesh, piece));
  std::size_t turned = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (volume_of(mesh, pieces[p]) >= 0) continue;
    bool is_cavity = false;
    for (std::size_t q = 0; q < pieces.size() && !is_cavity; ++q) {
      is_cavity = q != p && boxes[q].contains(boxes[p]) && is_within(mesh, pieces[p], pieces[q]);
    }
    if (is_cavity) continue;
    for (const std::uint32_t t : pieces[p]) turn(mesh, t);
    ++turned;
  }
  return turned;
}

/// Makes neighbours agree: in each piece, the part with less area turns. If the volume is then negative, all triangles
/// turn. Last, closed pieces of negative volume turn unless they are cavities within another piece. A piece is
/// connected by edges of two triangles. A piece that is not orientable keeps edges that disagree. O(triangles log
/// triangles); each piece of negative volume adds its triangles times those around it.
TurnedTriangles orient_pieces(TriangleMesh& mesh) {
  const Neighbours neighbours = neighbours_of(mesh);
  std::vector<bool> is_reached(mesh.triangles.size());
  TurnedTriangles turned;
  std::vector<Piece> pieces;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_reached[t]) continue;
    Reached reached = reach_from(t, neighbours, is_reached);
    turned.disagreeing += make_agree(mesh, reached);
    pieces.push_back(std::move(reached.triangles));
  }
  turned.whole = volume_of(mesh) < 0;
  if (turned.whole) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) turn(mesh, t);
  }
  // The volume of an open piece has no meaning.
  std::erase_if(pieces, [&](const Piece& piece) {
    return std::ranges::any_of(piece, [&](std::uint32_t t) { return neighbours[t].size() != 3; });
  });
  turned.pieces = turn_pieces(mesh, pieces);
  return turned;
}

using CornerIndices = std::array<std::uint32_t, 3>;

/// In squared size of the mesh: a triangle with less area counts as a line.
constexpr double k_least_area = 1e-14;

/// Rotates the corners so that the least index comes first.
CornerIndices rotated(CornerIndices corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

bool has_area(const TriangleMesh& mesh, const CornerIndices& corners, double least) {
  return doubled_area(mesh, corners).norm() > least;
}

void leave_out_flat(MendedMesh& mended) {
  const double least = k_least_area * bounds_of(mended.mesh.vertices).diagonal().squaredNorm();
  const std::size_t flat = std::erase_if(
      mended.mesh.triangles, [&](const CornerIndices& corners) { return !has_area(mended.mesh, corners, least); });
  if (flat > 0) mended.warnings.push_back(fmt::format("{} triangles of the mesh have no area and are left out.", flat));
}

void leave_out_repeated(MendedMesh& mended) {
  std::vector<CornerIndices>& triangles = mended.mesh.triangles;
  struct Entry {
    CornerIndices sorted;
    std::uint32_t index;
    bool is_even;  ///< orientation of the triangle relative to `sorted`
  };
  std::vector<Entry> entries;
  entries.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const CornerIndices corners = rotated(triangles[i]);
    const bool is_even = corners[1] < corners[2];
    entries.push_back({is_even ? corners : CornerIndices{corners[0], corners[2], corners[1]}, i, is_even});
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return std::pair(a.sorted, a.index) < std::pair(b.sorted, b.index); });
  struct Repeated {
    std::uint32_t first;
    bool is_back_to_back;
  };
  std::vector<char> goes(triangles.size(), 0);
  std::vector<Repeated> groups;
  std::size_t back_to_back = 0;
  std::size_t different = 0;
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    ++different;
    bool both = false;
    for (end = begin + 1; end < entries.size() && entries[end].sorted == entries[begin].sorted; ++end) {
      goes[entries[end].index] = 1;
      both = both || entries[end].is_even != entries[begin].is_even;
    }
    back_to_back += both ? 1 : 0;
    if (end - begin > 1) groups.push_back({entries[begin].index, both});
  }
  if (groups.empty()) return;
  const bool is_two_sided = 2 * back_to_back > different;
  for (const Repeated& group : groups) {
    if (group.is_back_to_back && !is_two_sided) goes[group.first] = 1;
  }
  std::vector<CornerIndices> kept;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (goes[i] == 0) kept.push_back(triangles[i]);
  }
  mended.warnings.push_back(fmt::format("{} triangles of the mesh have the same corners as others and are left out.",
                                        triangles.size() - kept.size()));
  triangles = std::move(kept);
}

void turn_outward(MendedMesh& mended) {
  const TurnedTriangles turned = orient_pieces(mended.mesh);
  if (turned.disagreeing > 0) {
    mended.warnings.push_back(fmt::format(
        "{} triangles of the mesh disagreed with their neighbours on which side is outside and were turned.",
        turned.disagreeing));
  }
  if (turned.whole) mended.warnings.emplace_back("The mesh was inside out (its volume was negative) and was turned.");
  if (turned.pieces > 0) {
    mended.warnings.push_back(
        fmt::format("Pieces of the mesh that were inside out, but not within others, were turned: {}", turned.pieces));
  }
}

void warn_of_faults(MendedMesh& mended, const RunContext& run) {
  const double diagonal = bounds_of(mended.mesh.vertices).diagonal().norm();
  const EdgeFaults edges = find_edge_faults(mended.mesh);
  if (edges.open.count > 0) {
    mended.warnings.push_back(fmt::format("The mesh is open: {} edges have only one triangle, the first near {}.",
                                          edges.open.count, place_text(edges.open.place, diagonal)));
  }
  if (edges.inconsistent.count > 0) {
    mended.warnings.push_back(
        fmt::format("Triangles of the mesh disagree on which side is outside at {} edges, the first near {}.",
                    edges.inconsistent.count, place_text(edges.inconsistent.place, diagonal)));
  }
  const MeshFault crossings = find_self_intersections(mended.mesh, run);
  if (crossings.count > 0) {
    mended.warnings.push_back(fmt::format("The mesh intersects itself: {} triangles, the first near {}.",
                                          crossings.count, place_text(crossings.place, diagonal)));
  }
}

}  // namespace

MendedMesh mend_mesh(const TriangleMesh& mesh, const RunContext& run) {
  MendedMesh mended{.mesh = mesh};
  leave_out_flat(mended);
  leave_out_repeated(mended);
  turn_outward(mended);
  run.throw_if_stopped();
  warn_of_faults(mended, run);
  return mended;
}

}  // namespace cloud2csg
