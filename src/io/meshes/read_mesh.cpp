#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "cloud2csg/mesh.hpp"
#include "io/formats/formats.hpp"
#include "io/meshes/formats.hpp"

namespace cloud2csg {
namespace {

struct MeshFormat {
  FileFormat::Id id;
  TriangleMesh (*read)(const FileContent&);
};

constexpr std::array<MeshFormat, 6> k_mesh_formats{{{FileFormat::Id::stl, read_stl},
                                                    {FileFormat::Id::off, read_off},
                                                    {FileFormat::Id::obj, read_obj},
                                                    {FileFormat::Id::ply, read_ply_mesh},
                                                    {FileFormat::Id::threemf, read_3mf},
                                                    {FileFormat::Id::glb, read_glb}}};

/// Joins vertices at the same place and drops triangles that thereby lose a corner.
TriangleMesh joined(const TriangleMesh& mesh) {
  const Points& points = mesh.vertices;
  const auto place = [&points](std::uint32_t i) { return std::tuple(points.x[i], points.y[i], points.z[i]); };
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
  // The first vertex at a place represents it, which keeps the order of the file.
  std::vector<std::uint32_t> first(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && place(order[i]) == place(order[i - 1]);
    first[order[i]] = repeats ? first[order[i - 1]] : order[i];
  }
  TriangleMesh result;
  std::vector<std::uint32_t> renumbered(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (first[i] != i) continue;
    renumbered[i] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(points[i]);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<std::uint32_t, 3> triangle{renumbered[first[a]], renumbered[first[b]], renumbered[first[c]]};
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) {
      result.triangles.push_back(triangle);
    }
  }
  return result;
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file) {
  const FileFormat::Id format = format_to_read(file, {FileKind::mesh}).format;
  const FileContent content(file);
  const TriangleMesh mesh = std::ranges::find(k_mesh_formats, format, &MeshFormat::id)->read(content);
  if (mesh.triangles.empty()) content.fail("expected triangles, found none");
  return joined(mesh);
}

}  // namespace cloud2csg
