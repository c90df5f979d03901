#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {

/// A tree of bounding boxes over the triangles of a mesh, for exact distances. Build O(n log n), query O(log n).
class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);

  /// Distance to the nearest point of any triangle; infinite for a mesh without triangles.
  [[nodiscard]] double distance(const Eigen::Vector3d& point) const;

 private:
  using Triangle = std::array<Eigen::Vector3d, 3>;
  struct Node {
    AlignedBox box;
    std::uint32_t first;  ///< leaf: first triangle; inner node: right child, the left one follows the node
    std::uint32_t count;  ///< triangles of a leaf; 0 for an inner node
  };

  struct Entry {
    Eigen::Vector3d centre;
    std::size_t triangle;
  };

  /// Adds the nodes over the entries, the first of which will be triangle number `first`; orders the entries. Boxes
  /// come later.
  void build(std::span<Entry> entries, std::size_t first);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

/// Square of the distance from a point to a triangle, which may be degenerate.
[[nodiscard]] double squared_distance(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& point);

}  // namespace cloud2csg
