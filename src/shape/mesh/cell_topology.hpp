#pragma once

#include <array>
#include <bit>
#include <cstdint>

/// How the surface runs through a grid cell, by the signs at its corners alone.
///
/// Corner c is at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge 4 a + k runs along axis a; the two bits of k are its
/// coordinates along axes (a + 1) % 3 and (a + 2) % 3. Face 2 a + s is across axis a, on side s.
namespace cloud2csg {

using CornerSigns = std::uint8_t;  ///< bit c: corner c is inside
using EdgeMask = std::uint16_t;    ///< bit e: edge e
using FaceMask = std::uint8_t;     ///< bit f: face f

constexpr int k_cell_edges = 12;
constexpr int k_most_loops = 4;

constexpr int corner_on(int axis, int u, int v, int along) {
  return (along << axis) | (u << ((axis + 1) % 3)) | (v << ((axis + 2) % 3));
}
constexpr int edge_low_corner(int edge) {
  return corner_on(edge / 4, edge & 1, (edge >> 1) & 1, 0);
}
constexpr int edge_high_corner(int edge) {
  return corner_on(edge / 4, edge & 1, (edge >> 1) & 1, 1);
}

/// The corners of a face in cyclic order; edges[i] joins corners[i] and corners[(i + 1) % 4].
struct Face {
  std::array<int, 4> corners;
  std::array<int, 4> edges;
};

constexpr Face face_of(int face) {
  const int axis = face / 2;
  const int side = face % 2;
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  // Along u an edge's coordinates are (v, axis), along v they are (axis, u).
  const auto along_u = [&](int at_v) { return 4 * u + at_v + 2 * side; };
  const auto along_v = [&](int at_u) { return 4 * v + side + 2 * at_u; };
  return {.corners = {corner_on(axis, 0, 0, side), corner_on(axis, 1, 0, side), corner_on(axis, 1, 1, side),
                      corner_on(axis, 0, 1, side)},
          .edges = {along_u(0), along_v(1), along_u(1), along_v(0)}};
}

constexpr bool is_inside(CornerSigns signs, int corner) {
  return ((signs >> corner) & 1) != 0;
}

/// Whether the inside corners are just two opposite ones, so that the signs do not determine how to join them.
constexpr bool is_ambiguous(CornerSigns signs, const Face& face) {
  const bool first = is_inside(signs, face.corners[0]);
  return is_inside(signs, face.corners[2]) == first && is_inside(signs, face.corners[1]) != first &&
         is_inside(signs, face.corners[3]) != first;
}

/// The edges that the surface crosses on one side of an ambiguous face: those around a cut-off corner. If `joined`, the
/// inside corners are connected across the face and the corner is outside. The other side has the other two edges.
constexpr EdgeMask ambiguous_segment(CornerSigns signs, const Face& face, bool joined) {
  const bool cut_off_first = is_inside(signs, face.corners[0]) != joined;
  return static_cast<EdgeMask>(cut_off_first ? (1 << face.edges[3]) | (1 << face.edges[0])
                                             : (1 << face.edges[0]) | (1 << face.edges[1]));
}

constexpr EdgeMask edges_of(const Face& face) {
  int mask = 0;
  for (const int edge : face.edges) mask |= 1 << edge;
  return static_cast<EdgeMask>(mask);
}

constexpr EdgeMask crossed_edges(CornerSigns signs) {
  int mask = 0;
  for (int edge = 0; edge < k_cell_edges; ++edge) {
    if (is_inside(signs, edge_low_corner(edge)) != is_inside(signs, edge_high_corner(edge))) mask |= 1 << edge;
  }
  return static_cast<EdgeMask>(mask);
}

/// The sheets of the surface in a cell. A loop of crossed edges, joined face by face, bounds each sheet.
struct Loops {
  std::array<EdgeMask, k_most_loops> edges = {};
  int count = 0;

  /// Precondition: the edge is crossed.
  [[nodiscard]] constexpr int loop_of(int edge) const {
    int loop = 0;
    while (((edges[static_cast<std::size_t>(loop)] >> edge) & 1) == 0) ++loop;
    return loop;
  }
};

/// `joined`: for ambiguous faces, whether the inside corners are connected across them.
constexpr Loops loops_of(CornerSigns signs, FaceMask joined) {
  const EdgeMask crossed = crossed_edges(signs);
  std::array<EdgeMask, 12> segments = {};
  std::size_t count = 0;
  for (int f = 0; f < 6; ++f) {
    const Face face = face_of(f);
    const auto on_face = static_cast<EdgeMask>(crossed & edges_of(face));
    if (on_face == 0) continue;
    const bool ambiguous = is_ambiguous(signs, face);
    const EdgeMask first = ambiguous ? ambiguous_segment(signs, face, ((joined >> f) & 1) != 0) : on_face;
    segments[count++] = first;
    if (ambiguous) segments[count++] = static_cast<EdgeMask>(on_face & ~first);
  }
  Loops loops;
  auto left = crossed;
  while (left != 0) {
    auto loop = static_cast<EdgeMask>(left & -left);
    // Each crossed edge has a segment on both of its faces, so growing by segments closes the loop.
    for (bool grown = true; grown;) {
      grown = false;
      for (std::size_t s = 0; s < count; ++s) {
        if ((segments[s] & loop) == 0 || (segments[s] & ~loop) == 0) continue;
        loop = static_cast<EdgeMask>(loop | segments[s]);
        grown = true;
      }
    }
    loops.edges[static_cast<std::size_t>(loops.count++)] = loop;
    left = static_cast<EdgeMask>(left & ~loop);
  }
  return loops;
}

}  // namespace cloud2csg
