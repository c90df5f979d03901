#include "shape/compare/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_leaf_triangles = 4;

double squared_distance_to_segment(const Vector3d& a, const Vector3d& b, const Vector3d& point) {
  const Vector3d along = b - a;
  const double square = along.squaredNorm();
  const double share = square > 0.0 ? std::clamp((point - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (point - a - share * along).squaredNorm();
}

}  // namespace

double squared_distance(const std::array<Vector3d, 3>& triangle, const Vector3d& point) {
  const auto& [a, b, c] = triangle;
  const Vector3d normal = (b - a).cross(c - a);
  const bool is_over_face = normal.dot((b - a).cross(point - a)) >= 0.0 &&
                            normal.dot((c - b).cross(point - b)) >= 0.0 && normal.dot((a - c).cross(point - c)) >= 0.0;
  const double square = normal.squaredNorm();
  if (is_over_face && square > 0.0) {
    const double height = normal.dot(point - a);
    return height * height / square;
  }
  return std::min({squared_distance_to_segment(a, b, point), squared_distance_to_segment(b, c, point),
                   squared_distance_to_segment(c, a, point)});
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return;
  const auto triangle_of = [&mesh](std::size_t index) -> Triangle {
    const auto& [a, b, c] = mesh.triangles[index];
    return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
  };
  std::vector<Entry> entries(mesh.triangles.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Triangle triangle = triangle_of(i);
    entries[i] = {.centre = (triangle[0] + triangle[1] + triangle[2]) / 3.0, .triangle = i};
  }
  nodes_.reserve(entries.size());
  build(entries, 0);
  triangles_.reserve(entries.size());
  for (const Entry& entry : entries) triangles_.push_back(triangle_of(entry.triangle));
  // Children come after their parent: from the back, every box is made of boxes that are done.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      for (const Vector3d& vertex : triangles_[node.first + i]) node.box.extend(vertex);
    }
    if (node.count == 0) node.box = nodes_[n + 1].box.merged(nodes_[node.first].box);
  }
}

void TriangleTree::build(std::span<Entry> entries, std::size_t first) {
  const std::size_t node = nodes_.size();
  if (entries.size() <= k_leaf_triangles) {
    nodes_.push_back(
        {.box = {}, .first = static_cast<std::uint32_t>(first), .count = static_cast<std::uint32_t>(entries.size())});
    return;
  }
  nodes_.push_back({.box = {}, .first = 0, .count = 0});
  AlignedBox centres;
  for (const Entry& entry : entries) centres.extend(entry.centre);
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::size_t half = entries.size() / 2;
  std::nth_element(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(half), entries.end(),
                   [axis](const Entry& a, const Entry& b) { return a.centre[axis] < b.centre[axis]; });
  build(entries.first(half), first);
  nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
  build(entries.subspan(half), first + half);
}

double TriangleTree::distance(const Vector3d& point) const {
  if (nodes_.empty()) return std::numeric_limits<double>::infinity();
  double best = std::numeric_limits<double>::infinity();
  struct Visit {
    std::uint32_t node;
    double square;  ///< of the distance to the node's box
  };
  // The depth is at most the logarithm of the number of triangles, which fits 32 bits; each level leaves one node.
  std::array<Visit, 64> stack;
  std::size_t height = 0;
  stack[height++] = {0, nodes_[0].box.squaredExteriorDistance(point)};
  while (height > 0) {
    const Visit visit = stack[--height];
    if (visit.square >= best) continue;
    const Node& node = nodes_[visit.node];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      best = std::min(best, squared_distance(triangles_[node.first + i], point));
    }
    if (node.count > 0) continue;
    Visit near{visit.node + 1, nodes_[visit.node + 1].box.squaredExteriorDistance(point)};
    Visit far{node.first, nodes_[node.first].box.squaredExteriorDistance(point)};
    if (far.square < near.square) std::swap(near, far);
    stack[height++] = far;
    stack[height++] = near;
  }
  return std::sqrt(best);
}

}  // namespace cloud2csg
