#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/mesh.hpp"
#include "io/clouds/file_content.hpp"

namespace cloud2csg {

/// Of parts within each other; a part that is within itself is told by it.
constexpr std::size_t k_most_levels = 100;

/// Builds a mesh vertex by vertex and polygon by polygon, as files have them; checks each number. Throws Error also
/// when there are 10 million things more than the file has bytes: few parts, placed many times, could make more than
/// any memory holds.
class MeshAssembly {
 public:
  explicit MeshAssembly(const FileContent& content) : content_(content) {}

  /// What follows is a part with vertices of its own that is moved so; where the motion mirrors, it is turned inside
  /// out, so that the outside stays outside.
  void start_part(const Eigen::Affine3d& motion);

  /// The first three numbers. @throws Error at `where` when there are fewer, or one is not finite in single precision.
  void add_vertex(std::span<const double> numbers, FilePosition where);

  /// Adds the triangles of a polygon, cut such that they do not cover each other where it is not convex. The vertices
  /// of the part are counted from `first`. Fewer than three corners are no polygon. O(corners) for a convex one.
  /// @throws Error at `where` for a number that is no vertex so far.
  void add_polygon(std::span<const double> corners, FilePosition where, std::size_t first = 0);

  /// Of the part.
  [[nodiscard]] std::size_t vertex_count() const { return mesh_.vertices.size() - part_begin_; }
  [[nodiscard]] TriangleMesh finish() && { return std::move(mesh_); }

 private:
  using Corners = std::array<std::uint32_t, 3>;

  void grow(std::size_t things);
  void add_triangle(const Corners& corners);
  void cut_ring(FilePosition where);
  /// Of a triangle, seen against the normal and in some unit: negative when it is the other way round.
  [[nodiscard]] double area(const Corners& corners, const Eigen::Vector3d& normal) const;
  [[nodiscard]] bool is_in(std::uint32_t vertex, const Corners& ear, const Eigen::Vector3d& normal) const;

  const FileContent& content_;
  TriangleMesh mesh_ = {};
  Eigen::Affine3d motion_ = Eigen::Affine3d::Identity();
  bool mirrors_ = false;
  std::size_t part_begin_ = 0;            ///< among the vertices
  std::size_t size_ = 0;                  ///< of vertices, triangles and parts
  std::vector<std::uint32_t> ring_ = {};  ///< corners of the polygon that is being added
  std::size_t looked_at_ = 0;             ///< corners, when polygons were cut
};

}  // namespace cloud2csg
