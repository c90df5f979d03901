#include "io/meshes/mesh_faults.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/parallel.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
namespace bg = boost::geometry;
using IndexPoint = bg::model::point<double, 3, bg::cs::cartesian>;
using IndexBox = bg::model::box<IndexPoint>;
using TriangleIndex = bg::index::rtree<std::pair<IndexBox, std::uint32_t>, bg::index::linear<16>>;

constexpr std::size_t k_triangles_a_task = 1024;
/// Relative to a length: closer than this counts as touching, because most mesh files are in single precision.
constexpr double k_touching = 1e-6;

using CornerPoints = std::array<Vector3d, 3>;

CornerPoints corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

IndexBox box_of(const CornerPoints& corners) {
  const Vector3d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Vector3d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  return {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
}

/// Whether the segment crosses the interior of the triangle by more than rounding.
bool passes_through(const Vector3d& from, const Vector3d& to, const CornerPoints& triangle) {
  const Vector3d along = to - from;
  const Vector3d first = triangle[1] - triangle[0];
  const Vector3d second = triangle[2] - triangle[0];
  const Vector3d normal = first.cross(second);
  const double slack = k_touching * normal.norm() * std::max(along.norm(), std::sqrt(normal.norm()));
  const double height_from = normal.dot(from - triangle[0]);
  const double height_to = normal.dot(to - triangle[0]);
  if (!((height_from > slack && height_to < -slack) || (height_from < -slack && height_to > slack))) return false;
  const Vector3d place = from + height_from / (height_from - height_to) * along - triangle[0];
  const double square = normal.squaredNorm();
  const double share_first = normal.dot(place.cross(second)) / square;
  const double share_second = normal.dot(first.cross(place)) / square;
  return share_first > k_touching && share_second > k_touching && share_first + share_second < 1.0 - k_touching;
}

bool edges_pass_through(const CornerPoints& edges, const CornerPoints& triangle) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (passes_through(edges[i], edges[(i + 1) % 3], triangle)) return true;
  }
  return false;
}

bool share_a_vertex(const TriangleMesh& mesh, std::size_t one, std::size_t other) {
  const auto& second = mesh.triangles[other];
  return std::ranges::any_of(mesh.triangles[one],
                             [&](std::uint32_t v) { return std::ranges::find(second, v) != second.end(); });
}

bool meets_another(const TriangleMesh& mesh, const TriangleIndex& index, std::size_t triangle) {
  const CornerPoints corners = corners_of(mesh, triangle);
  return std::any_of(index.qbegin(bg::index::intersects(box_of(corners))), index.qend(), [&](const auto& entry) {
    if (share_a_vertex(mesh, triangle, entry.second)) return false;
    const CornerPoints other = corners_of(mesh, entry.second);
    return edges_pass_through(corners, other) || edges_pass_through(other, corners);
  });
}

}  // namespace

EdgeFaults find_edge_faults(const TriangleMesh& mesh) {
  struct Edge {
    std::uint32_t low, high;
    bool is_forward;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangle[i];
      const std::uint32_t to = triangle[(i + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  }
  const auto key = [](const Edge& edge) { return std::pair(edge.low, edge.high); };
  std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return key(a) < key(b); });
  EdgeFaults faults;
  const auto add = [&mesh](MeshFault& fault, const Edge& edge) {
    if (fault.count++ == 0) fault.place = 0.5 * (mesh.vertices[edge.low] + mesh.vertices[edge.high]);
  };
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    std::size_t forward = 0;
    for (end = begin; end < edges.size() && key(edges[end]) == key(edges[begin]); ++end) {
      forward += edges[end].is_forward ? 1 : 0;
    }
    const std::size_t backward = end - begin - forward;
    if (end - begin == 1) add(faults.open, edges[begin]);
    if (end - begin > 1 && forward != backward) add(faults.inconsistent, edges[begin]);
  }
  return faults;
}

MeshFault find_self_intersections(const TriangleMesh& mesh, const RunContext& run) {
  const std::size_t count = mesh.triangles.size();
  std::vector<std::pair<IndexBox, std::uint32_t>> entries;
  entries.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    entries.emplace_back(box_of(corners_of(mesh, i)), static_cast<std::uint32_t>(i));
  }
  const TriangleIndex index(entries);
  std::vector<char> meets(count, 0);
  for_each_index((count + k_triangles_a_task - 1) / k_triangles_a_task, run, [&](std::size_t task) {
    const std::size_t end = std::min(count, (task + 1) * k_triangles_a_task);
    for (std::size_t i = task * k_triangles_a_task; i < end; ++i) meets[i] = meets_another(mesh, index, i) ? 1 : 0;
  });
  MeshFault fault;
  for (std::size_t i = 0; i < count; ++i) {
    if (meets[i] == 0 || fault.count++ > 0) continue;
    const CornerPoints corners = corners_of(mesh, i);
    fault.place = (corners[0] + corners[1] + corners[2]) / 3.0;
  }
  return fault;
}

}  // namespace cloud2csg
