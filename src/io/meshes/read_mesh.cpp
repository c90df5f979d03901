#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <numeric>
#include <string>
#include <string_view>
#include <tuple>

#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "core/base/file_ending.hpp"

namespace cloud2csg {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string expected, std::string remedy = {}) {
  throw Error({.file = file.string(), .where = {}, .expected = std::move(expected), .remedy = std::move(remedy)});
}

void require_readable(const std::filesystem::path& file) {
  const std::string ending = lower_ending(file);
  constexpr std::array<std::string_view, 6> k_endings{".stl", ".off", ".obj", ".ply", ".3mf", ".glb"};
  if (std::find(k_endings.begin(), k_endings.end(), ending) == k_endings.end()) {
    fail(file, fmt::format("expected a file ending in .stl, .off, .obj, .ply, .3mf or .glb, found \"{}\"", ending));
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    fail(file, fmt::format("cannot be read ({})", error ? error.message() : "not a file"),
         "check the path and its permissions");
  }
}

/// Appends the triangles of one part of the scene, corners not yet joined.
void append(TriangleMesh& mesh, const aiMesh& part, const std::filesystem::path& file) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
      fail(file, fmt::format("expected finite coordinates, found ({}, {}, {})", v.x, v.y, v.z));
    }
    mesh.vertices.push_back({v.x, v.y, v.z});
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;
    mesh.triangles.push_back({offset + face.mIndices[0], offset + face.mIndices[1], offset + face.mIndices[2]});
  }
}

/// Vertices at the same place become one; triangles that lose a corner by it go.
TriangleMesh joined(const TriangleMesh& mesh) {
  const Points& points = mesh.vertices;
  const auto place = [&points](std::uint32_t i) { return std::tuple(points.x[i], points.y[i], points.z[i]); };
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
  // Each vertex's first appearance stands for it, so that the order of the file is kept.
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
  require_readable(file);
  Assimp::Importer importer;
  // .3mf and .glb place their parts by a tree of motions.
  constexpr unsigned k_steps = unsigned{aiProcess_Triangulate} | unsigned{aiProcess_PreTransformVertices};
  const aiScene* scene = importer.ReadFile(file.string(), k_steps);
  if (scene == nullptr) fail(file, fmt::format("cannot be read as a mesh ({})", importer.GetErrorString()));
  TriangleMesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) append(mesh, *scene->mMeshes[i], file);
  if (mesh.triangles.empty()) fail(file, "expected triangles, found none", "a point cloud is no mesh");
  return joined(mesh);
}

}  // namespace cloud2csg
