#include <algorithm>
#include <cstdint>
#include <vector>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {

bool is_watertight(const TriangleMesh& mesh) {
  // Every directed edge must appear once, and so must its opposite.
  std::vector<std::uint64_t> forward;
  std::vector<std::uint64_t> backward;
  forward.reserve(3 * mesh.triangles.size());
  backward.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t from = triangle[i];
      const std::uint64_t to = triangle[(i + 1) % 3];
      if (from == to) return false;
      forward.push_back(from << 32U | to);
      backward.push_back(to << 32U | from);
    }
  }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  return std::adjacent_find(forward.begin(), forward.end()) == forward.end() && forward == backward;
}

double volume_of(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  // Tetrahedra from a vertex of the mesh: less cancellation far from the origin.
  const Eigen::Vector3d apex = mesh.vertices[0];
  double six_volumes = 0;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[triangle[0]] - apex;
    const Eigen::Vector3d b = mesh.vertices[triangle[1]] - apex;
    const Eigen::Vector3d c = mesh.vertices[triangle[2]] - apex;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

}  // namespace cloud2csg
