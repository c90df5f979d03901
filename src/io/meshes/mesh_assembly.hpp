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

/// Limit of nested parts; also detects a part that contains itself.
constexpr std::size_t k_most_levels = 100;

/// Builds a mesh from a file by vertices and polygons, and checks each number. Throws Error if the mesh has 10 million
/// things more than the file has bytes: a few parts placed many times could exceed any memory.
class MeshAssembly {
 public:
  explicit MeshAssembly(const FileContent& content) : content_(content) {}

  /// Starts a part with its own vertices, moved by `motion`. Its outside stays outside even if the motion mirrors.
  void start_part(const Eigen::Affine3d& motion);

  /// Uses the first three numbers. @throws Error at `where` for fewer, or one that is not finite in single precision.
  void add_vertex(std::span<const double> numbers, FilePosition where);

  /// Adds a polygon as triangles that do not overlap. Vertices of the part count from `first`. Ignores fewer than three
  /// corners. O(corners) for a convex polygon. @throws Error at `where` for a number that is no vertex so far.
  void add_polygon(std::span<const double> corners, FilePosition where, std::size_t first = 0);

  /// Vertices of the current part.
  [[nodiscard]] std::size_t vertex_count() const { return mesh_.vertices.size() - part_begin_; }
  [[nodiscard]] TriangleMesh finish() && { return std::move(mesh_); }

 private:
  using Corners = std::array<std::uint32_t, 3>;

  void grow(std::size_t things);
  void add_triangle(const Corners& corners);
  void cut_ring(FilePosition where);
  /// Signed area along `normal`, up to a positive factor; negative for the reverse orientation.
  [[nodiscard]] double area(const Corners& corners, const Eigen::Vector3d& normal) const;
  [[nodiscard]] bool is_in(std::uint32_t vertex, const Corners& ear, const Eigen::Vector3d& normal) const;

  const FileContent& content_;
  TriangleMesh mesh_ = {};
  Eigen::Affine3d motion_ = Eigen::Affine3d::Identity();
  bool mirrors_ = false;
  std::size_t part_begin_ = 0;            ///< first vertex of the current part
  std::size_t size_ = 0;                  ///< vertices, triangles and parts
  std::vector<std::uint32_t> ring_ = {};  ///< corners of the current polygon
  std::size_t looked_at_ = 0;             ///< corners tested so far while cutting polygons
};

}  // namespace cloud2csg
