#include "io/scanned_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/input.hpp"
#include "core/base/robust_deviation.hpp"
#include "core/geometry/facet.hpp"
#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// Fewer vertices measure no noise, and no features. At half or double, the same meshes are scans.
constexpr std::size_t k_least_vertices = 2000;
/// Longest edge of a small facet, in edges of an equilateral facet of mean area. Facets of marching cubes reach 2. At
/// half, those would be large; at double, the facets of a cylinder from a CAD program would be small.
constexpr double k_small_facet = 3;
/// Least share of the surface that small facets cover. The rest are holes that a program filled, and trimmed flats.
constexpr double k_small_share = 0.9;
/// Least noise, in spacings of the vertices: it tilts facets by some two degrees. At half, it would be mistaken for the
/// curvature between vertices; at double, the normals of facets are less certain than those of clouds.
constexpr double k_least_noise = 0.02;
/// Least ratio of the heights' second differences and their first ones. Independent noise has 1.25, after smoothing
/// 0.9; curved exact meshes have up to 0.2, even if their facets are coarse. At half, those would be scans; at double,
/// smoothed scans would be exact.
constexpr double k_least_roughness = 0.5;

/// The small facets cover nearly everything; `large` are the others.
struct FacetSizes {
  std::vector<std::array<std::uint32_t, 3>> large = {};
  double area = 0, large_area = 0;

  [[nodiscard]] double small_area() const { return area - large_area; }
};

double longest_edge_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& corners) {
  const Vector3d a = mesh.vertices[corners[0]];
  const Vector3d b = mesh.vertices[corners[1]];
  const Vector3d c = mesh.vertices[corners[2]];
  return std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
}

FacetSizes by_size(const TriangleMesh& mesh) {
  FacetSizes sizes;
  for (const auto& corners : mesh.triangles) sizes.area += 0.5 * doubled_area(mesh, corners).norm();
  const double mean_edge = std::sqrt(4 / std::sqrt(3.0) * sizes.area / static_cast<double>(mesh.triangles.size()));
  for (const auto& corners : mesh.triangles) {
    if (longest_edge_of(mesh, corners) <= k_small_facet * mean_edge) continue;
    sizes.large.push_back(corners);
    sizes.large_area += 0.5 * doubled_area(mesh, corners).norm();
  }
  return sizes;
}

std::vector<std::uint32_t> used_vertices(const TriangleMesh& mesh) {
  std::vector<bool> is_used(mesh.vertices.size(), false);
  for (const auto& corners : mesh.triangles) {
    for (const std::uint32_t vertex : corners) is_used[vertex] = true;
  }
  return places_where(is_used);
}

/// Unit normals of vertices, weighted by the facets' areas.
Points vertex_normals(const TriangleMesh& mesh) {
  Points normals(mesh.vertices.size());
  for (const auto& corners : mesh.triangles) {
    const Vector3d facet = doubled_area(mesh, corners);
    for (const std::uint32_t vertex : corners) normals.set(vertex, normals[vertex] + facet);
  }
  for (std::size_t i = 0; i < normals.size(); ++i) normals.set(i, normals[i].stableNormalized());
  return normals;
}

/// By vertex: the mean of its neighbours' values minus its own. The other facet of an edge adds the edge's ends the
/// other way round.
Points differences(const TriangleMesh& mesh, const Points& values) {
  Points sums(values.size());
  std::vector<double> counts(values.size(), 0);
  for (const auto& corners : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t to = corners[(k + 1) % 3];
      sums.set(to, sums[to] + values[corners[k]]);
      counts[to] += 1;
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    sums.set(i, counts[i] > 0 ? Vector3d(sums[i] / counts[i] - values[i]) : Vector3d(Vector3d::Zero()));
  }
  return sums;
}

double median_height(const Points& offsets, const Points& normals, const std::vector<std::uint32_t>& vertices) {
  std::vector<double> heights;
  heights.reserve(vertices.size());
  for (const std::uint32_t i : vertices) heights.push_back(std::abs(offsets[i].dot(normals[i])));
  return median_of(heights);
}

/// Whether heights differ from vertex to vertex as noise does. Those of a curved surface change slowly.
bool is_rough(const TriangleMesh& mesh, const std::vector<std::uint32_t>& vertices) {
  const Points normals = vertex_normals(mesh);
  const Points first = differences(mesh, mesh.vertices);
  const Points second = differences(mesh, first);
  return median_height(second, normals, vertices) > k_least_roughness * median_height(first, normals, vertices);
}

/// Absent where the points have no scale, such as repeated ones.
std::optional<Scale> scale_of(const PointCloud& cloud, const RunContext& run) {
  try {
    return estimate_scale(cloud, run);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<ScannedPoints> scanned_points(const TriangleMesh& mesh, std::uint64_t seed, const RunContext& run) {
  const std::vector<std::uint32_t> vertices = used_vertices(mesh);
  if (vertices.size() < k_least_vertices) return std::nullopt;
  const FacetSizes sizes = by_size(mesh);
  if (!(sizes.small_area() > 0 && sizes.small_area() >= k_small_share * sizes.area)) return std::nullopt;
  if (!is_rough(mesh, vertices)) return std::nullopt;
  ScannedPoints scan{.cloud = {.positions = select_points(mesh.vertices.view(), vertices)}};
  const std::optional<Scale> scale = scale_of(scan.cloud, run);
  if (!scale || !(scale->noise >= k_least_noise * scale->spacing)) return std::nullopt;
  scan.noise = scale->noise;
  // As dense as the vertices elsewhere.
  const auto wanted =
      static_cast<std::size_t>(static_cast<double>(vertices.size()) * sizes.large_area / sizes.small_area());
  if (wanted > 0) {
    RunContext silent = run;
    silent.on_progress = {};
    const TriangleMesh large{.vertices = mesh.vertices, .triangles = sizes.large};
    append(scan.cloud.positions, sample_mesh(large, {.mesh_points = wanted, .seed = seed}, silent).positions);
  }
  run.report("read", scan.cloud.size(), scan.cloud.size(), "points");
  return scan;
}

}  // namespace cloud2csg
