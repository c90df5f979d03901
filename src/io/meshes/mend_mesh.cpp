#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "cloud2csg/input.hpp"
#include "core/geometry/place_text.hpp"
#include "io/meshes/mesh_faults.hpp"
#include "io/meshes/orient_pieces.hpp"

namespace cloud2csg {
namespace {

using CornerIndices = std::array<std::uint32_t, 3>;

/// Of the squared size: triangles with less area are taken for lines.
constexpr double k_least_area = 1e-14;

/// The corners in the same cyclic order, the least first.
CornerIndices rotated(CornerIndices corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

bool has_area(const TriangleMesh& mesh, const CornerIndices& corners, double least) {
  const Eigen::Vector3d a = mesh.vertices[corners[0]];
  return (mesh.vertices[corners[1]] - a).cross(mesh.vertices[corners[2]] - a).norm() > least;
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
    bool is_even;  ///< of the two ways round
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
  mended.warnings.push_back(
      fmt::format("{} triangles of the mesh lie on others with the same corners and are left out.",
                  triangles.size() - kept.size()));
  triangles = std::move(kept);
}

void turn_outward(MendedMesh& mended) {
  const TurnedTriangles turned = orient_pieces(mended.mesh);
  if (turned.disagreeing > 0) {
    mended.warnings.push_back(
        fmt::format("{} triangles of the mesh disagreed with their neighbours on which side is "
                    "outside. They were turned.",
                    turned.disagreeing));
  }
  if (turned.whole) mended.warnings.emplace_back("The mesh is inside out: its volume is negative. It was turned.");
  if (turned.pieces > 0) {
    mended.warnings.push_back(
        fmt::format("Pieces of the mesh that were inside out, and not within others, were turned: {}", turned.pieces));
  }
}

void warn_of_faults(MendedMesh& mended, const RunContext& run) {
  const double diagonal = bounds_of(mended.mesh.vertices).diagonal().norm();
  const EdgeFaults edges = find_edge_faults(mended.mesh);
  if (edges.open.count > 0) {
    mended.warnings.push_back(fmt::format("The mesh is open: {} edges have one triangle only, the first near {}.",
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
