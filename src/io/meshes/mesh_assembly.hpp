#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/mesh.hpp"
#include "io/clouds/file_content.hpp"

namespace cloud2csg {

/// Builds a mesh vertex by vertex and polygon by polygon, as files have them; checks each number.
class MeshAssembly {
 public:
  explicit MeshAssembly(const FileContent& content) : content_(content) {}

  /// The first three numbers. @throws Error at `where` when there are fewer, or one is not finite in single precision.
  void add_vertex(std::span<const double> numbers, FilePosition where);

  /// Adds the triangles of a polygon, cut such that they do not cover each other where it is not convex. The vertices
  /// are counted from `first`. Fewer than three corners are no polygon. O(corners) for a convex one.
  /// @throws Error at `where` for a number that is no vertex so far.
  void add_polygon(std::span<const double> corners, FilePosition where, std::size_t first = 0);

  [[nodiscard]] std::size_t vertex_count() const { return mesh_.vertices.size(); }
  [[nodiscard]] TriangleMesh finish() && { return std::move(mesh_); }

 private:
  void cut_ring(FilePosition where);
  /// Of a triangle, seen against the normal and in some unit: negative when it is the other way round.
  [[nodiscard]] double area(const std::array<std::uint32_t, 3>& corners, const Eigen::Vector3d& normal) const;
  [[nodiscard]] bool is_in(std::uint32_t vertex, const std::array<std::uint32_t, 3>& ear,
                           const Eigen::Vector3d& normal) const;

  const FileContent& content_;
  TriangleMesh mesh_ = {};
  std::vector<std::uint32_t> ring_ = {};  ///< corners of the polygon that is being added
  std::size_t looked_at_ = 0;             ///< corners, when polygons were cut
};

/// @throws Error at `where` unless all coordinates are finite in single precision: squares of larger ones may not be.
void check_coordinates(const FileContent& content, const Eigen::Vector3d& position, FilePosition where);

}  // namespace cloud2csg
